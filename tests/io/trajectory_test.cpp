// run.h5: its layout as others read it, and cutting back.

#include "io/digest.hpp"
#include "io/hdf5_file.hpp"
#include "io/inspect.hpp"
#include "monitors/orbital_monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "tests/io/support.hpp"
#include "tests/support/drivers.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

using namespace noether;
using test::error_of;
using test::WritingRun;

#if NOETHER_HDF5

namespace {}  // namespace

TEST_CASE("h5py finds the layout of H5MD, and Python's digest of the last frame is the run's", "[trajectory]") {
  const test::ScratchFolder folder;
  WritingRun run(folder / "run.h5");
  REQUIRE(run.simulation.run(100).ok());
  run.writer->flush();
  const std::string file = (folder / "run.h5").string();
  const auto output = test::python_output("read_trajectory.py", {file, "21", "5", "40", "solar"});
  if (output) CHECK(*output == io::digest(run.simulation.particles()) + "\n");
  CHECK(io::info(folder / "run.h5").digest == io::digest(run.simulation.particles()));
}

TEST_CASE("MDAnalysis reads every frame, in solar, reduced and molecular units", "[trajectory][slow]") {
  for (const std::string units : {"solar", "reduced", "molecular"}) {
    const test::ScratchFolder folder;
    ParticleSystem<double> particles(unit_system(units));
    const ParticleSystem<double> planets = test::outer_planets();
    for (Index i = 0; i < planets.size(); ++i) {
      particles.add(planets.name(i), planets.masses()[i], planets.positions()[i], planets.velocities()[i]);
    }
    WritingRun run(folder / "run.h5", particles);
    REQUIRE(run.simulation.run(1500).ok());
    run.writer->flush();
    const auto output = test::python_output("read_with_mdanalysis.py", {(folder / "run.h5").string()});
    if (output) CHECK(*output == "301 frames\n");
    test::python_output("read_trajectory.py", {(folder / "run.h5").string(), "301", "5", "40", units});
  }
}

TEST_CASE("particles stand in id order in every frame, whatever their order in memory", "[trajectory]") {
  const test::ScratchFolder folder;
  ParticleSystem<double> shuffled(unit_system("solar"));
  const ParticleSystem<double> planets = test::outer_planets();
  const std::vector<Index> order = {3, 0, 5, 1, 4, 2};
  for (const Index i : order)
    shuffled.add(planets.name(i), planets.masses()[i], planets.positions()[i], planets.velocities()[i]);
  shuffled.restore_ids({30, 0, 50, 10, 40, 20});
  WritingRun run(folder / "run.h5", shuffled);
  REQUIRE(run.simulation.run(10).ok());
  run.writer->flush();
  const io::Frames frames = io::read_frames(folder / "run.h5");
  CHECK(frames.ids == std::vector<std::int64_t>{0, 10, 20, 30, 40, 50});
  CHECK(frames.names == planets.names());
  REQUIRE(frames.frames.size() == 3);
  for (Index i = 0; i < planets.size(); ++i) {
    const std::size_t at = 3 * static_cast<std::size_t>(i);
    CHECK(frames.frames[0].positions[at] == planets.positions()[i][0]);
    CHECK(frames.frames[0].velocities[at + 2] == planets.velocities()[i][2]);
    CHECK(frames.masses[static_cast<std::size_t>(i)] == planets.masses()[i]);
  }
  CHECK(io::info(folder / "run.h5").digest == io::digest(run.simulation.particles()));
}

TEST_CASE("monitors' samples stand in the file as they were, with unit, shape and scale", "[trajectory]") {
  const test::ScratchFolder folder;
  WritingRun run(folder / "run.h5");
  run.simulation.every(20, Elements{});
  REQUIRE(run.simulation.run(60).ok());
  run.writer->flush();
  const std::vector<io::MonitorSeries> monitors = io::read_monitors(folder / "run.h5");
  REQUIRE(monitors.size() == 3);
  const io::MonitorSeries &angular = monitors[0], &elements = monitors[1], &energy = monitors[2];
  CHECK(angular.name == "angular_momentum");
  CHECK(elements.name == "elements");
  CHECK(energy.name == "energy");
  CHECK(energy.step.size() == 21);
  CHECK(energy.step.back() == 60);
  CHECK(energy.time.back() == 60 * 40.0);
  CHECK(energy.quantities.at("total").first.empty());
  CHECK(energy.quantities.at("total").second.back() == run.energy->total());
  CHECK(energy.scale == run.energy->scale());
  CHECK(energy.units.at("total") == "Msun au^2/day^2");
  CHECK(energy.units.at("relative_error") == "1");
  CHECK(energy.units.at("time") == "day");
  CHECK(angular.quantities.at("value").first == std::vector<Index>{3});
  CHECK(angular.quantities.at("value").second.size() == 21);
  CHECK(angular.quantities.at("value").second.back() == run.angular->value()[2]);
  CHECK(elements.quantities.at("value").first.size() == 2);
  CHECK(elements.quantities.at("value").first.back() == 6);
  CHECK(elements.units.at("value") == "au, 1, rad, rad, rad, rad");
  CHECK(io::Hdf5File::open_to_read(folder / "run.h5").has_attribute("/noether/monitors/elements/value", "columns"));
}

TEST_CASE("a file can be read from its first frame on, whatever becomes of the run", "[trajectory]") {
  const test::ScratchFolder folder;
  WritingRun run(folder / "run.h5");
  REQUIRE(run.simulation.run(0).ok());
  const std::filesystem::path seen = folder / "seen.h5";  // what a killed run would leave
  std::filesystem::copy_file(folder / "run.h5", seen);
  CHECK(io::verify(seen).damaged.empty());
}

TEST_CASE("a series that names its columns has them in the file", "[trajectory]") {
  struct Counter {
    static constexpr auto describe() {
      return part<Counter>("counter", "the step, twice", state<&Counter::step>("step"));
    }
    void observe(const Snapshot<double>& now) { step = now.step(); }
    std::vector<Series> series() const {
      const auto x = static_cast<double>(step);
      return {{"value", "various", {2, 2}, {x, -x, x, -x}, {"up", "down"}}};
    }
    std::int64_t step = 0;
  };
  const test::ScratchFolder folder;
  WritingRun run(folder / "run.h5");
  run.simulation.every(1, Counter{});
  REQUIRE(run.simulation.run(4).ok());
  run.writer->flush();
  const io::Hdf5File file = io::Hdf5File::open_to_read(folder / "run.h5");
  const std::string path = "/noether/monitors/counter/value";
  CHECK(file.open(path).shape() == std::vector<Index>{5, 2, 2});
  CHECK(file.has_attribute(path, "columns"));
  CHECK_FALSE(file.has_attribute("/noether/monitors/energy/total", "columns"));
  CHECK(file.text_attribute(path, "noether_unit") == "various");
  CHECK(file.open(path).read_reals(3, 1) == std::vector<double>{3, -3, 3, -3});
}

TEST_CASE("the shadow Hamiltonian stands in the file with its orders, a row for each window", "[trajectory]") {
  const test::ScratchFolder folder;
  WritingRun run(folder / "run.h5");
  run.simulation.every(1, ShadowHamiltonian<>({4, 8}));
  REQUIRE(run.simulation.run(20).ok());
  run.writer->flush();
  const io::Hdf5File file = io::Hdf5File::open_to_read(folder / "run.h5");
  const std::string group = "/noether/monitors/shadow_hamiltonian/";
  CHECK(file.open(group + "value").shape() == std::vector<Index>{17, 2});
  CHECK(file.open(group + "fluctuation").shape() == std::vector<Index>{17, 2});
  CHECK(file.open(group + "step").read_integers().front() == 4);
  for (const char* name : {"value", "fluctuation"}) {
    CHECK(file.integers_attribute(group + name, "orders") == std::vector<std::int64_t>{4, 8});
  }
  CHECK(file.has_attribute(group + "value", "noether_unit"));
}

TEST_CASE("a resumed run's file equals that of an uninterrupted one, value for value", "[trajectory][restart]") {
  const test::ScratchFolder folder;
  WritingRun whole(folder / "whole.h5");
  REQUIRE(whole.simulation.run(200).ok());
  whole.writer->finish(Outcome{});

  // Goes on after the save, as a run does that is killed later: what follows must be cut away.
  SavedRun saved;
  {
    WritingRun first(folder / "run.h5");
    REQUIRE(first.simulation.run(77).ok());
    first.writer->flush();
    saved = first.simulation.save();
    REQUIRE(first.simulation.run(60).ok());
    first.writer->finish(Outcome{});
  }
  WritingRun second(folder / "run.h5");
  second.simulation.restore(saved);
  REQUIRE(second.simulation.run(123).ok());
  second.writer->finish(Outcome{});

  test::check_same_content(folder / "whole.h5", folder / "run.h5");
  const io::Frames a = io::read_frames(folder / "whole.h5"), b = io::read_frames(folder / "run.h5");
  REQUIRE(a.frames.size() == 41);
  REQUIRE(b.frames.size() == 41);
  for (std::size_t k = 0; k < a.frames.size(); ++k) {
    CHECK(a.frames[k].step == b.frames[k].step);
    CHECK(a.frames[k].positions == b.frames[k].positions);
  }
}

TEST_CASE("a run may go back within one program, again and again", "[trajectory][restart]") {
  const test::ScratchFolder folder;
  WritingRun run(folder / "run.h5");
  REQUIRE(run.simulation.run(30).ok());
  const SavedRun saved = run.simulation.save();
  for (int k = 0; k < 3; ++k) {
    REQUIRE(run.simulation.run(50 + k).ok());
    run.simulation.restore(saved);
  }
  REQUIRE(run.simulation.run(70).ok());
  run.writer->finish(Outcome{});
  WritingRun whole(folder / "whole.h5");
  REQUIRE(whole.simulation.run(100).ok());
  whole.writer->finish(Outcome{});
  test::check_same_content(folder / "whole.h5", folder / "run.h5");
}

TEST_CASE("a run saved before its first step writes its file anew", "[trajectory][restart]") {
  const test::ScratchFolder folder;
  WritingRun run(folder / "run.h5"), whole(folder / "whole.h5");
  const SavedRun before_the_first_step = run.simulation.save();
  REQUIRE(run.simulation.run(20).ok());
  run.simulation.restore(before_the_first_step);
  REQUIRE(run.simulation.run(20).ok());
  run.writer->finish(Outcome{});
  REQUIRE(whole.simulation.run(20).ok());
  whole.writer->finish(Outcome{});
  test::check_same_content(folder / "whole.h5", folder / "run.h5");
}

TEST_CASE("complete is set by a run that ended as asked, and taken back when it goes on", "[trajectory]") {
  const test::ScratchFolder folder;
  WritingRun run(folder / "run.h5");
  REQUIRE(run.simulation.run(10).ok());
  run.writer->flush();
  CHECK_FALSE(io::info(folder / "run.h5").complete);
  Outcome outcome;
  outcome.kind = Outcome::Kind::interrupted;
  run.writer->finish(outcome);
  CHECK_FALSE(io::info(folder / "run.h5").complete);
  outcome.kind = Outcome::Kind::stopped;
  run.writer->finish(outcome);
  CHECK(io::info(folder / "run.h5").complete);
  run.simulation.restore(run.simulation.save());
  run.writer->flush();
  CHECK_FALSE(io::info(folder / "run.h5").complete);
}

TEST_CASE("without frames the samples of monitors alone are written", "[trajectory]") {
  const test::ScratchFolder folder;
  Simulation simulation(test::outer_planets(),
                        compose(test::kinetic_potential(Gravity{.G = test::outer_G}), schemes::verlet), 40.0);
  simulation.every(2, Energy{});
  auto& writer = simulation.every(100, io::TrajectoryWriter(folder / "run.h5", {.frames = false}));
  REQUIRE(simulation.run(9).ok());
  writer.finish(Outcome{});
  const io::FileInfo info = io::verify(folder / "run.h5");
  CHECK(info.damaged.empty());
  CHECK(info.frames == 0);
  CHECK(info.last_step == 8);
  CHECK(info.particles == 6);
  CHECK(io::read_monitors(folder / "run.h5").at(0).step == std::vector<std::int64_t>{0, 2, 4, 6, 8});
}

TEST_CASE("a trajectory that cannot be gone on with is refused, in one line", "[trajectory][messages]") {
  const test::ScratchFolder folder;
  const std::string file = (folder / "run.h5").string();
  WritingRun run(folder / "run.h5");
  REQUIRE(run.simulation.run(10).ok());
  const SavedRun early = run.simulation.save();
  REQUIRE(run.simulation.run(10).ok());
  const SavedRun saved = run.simulation.save();
  run.simulation.restore(early);  // cuts the file back
  CHECK(error_of([&] { WritingRun(file).simulation.restore(saved); }) ==
        file +
            ": '/particles/system/position/step' holds 3 rows where the saved run expects 5; the file was cut or "
            "replaced: bring it back, or start over");
  std::filesystem::remove(file);
  CHECK(error_of([&] { WritingRun(file).simulation.restore(saved); }) ==
        file + ": the trajectory that the saved run continues is missing; bring it back, or start over");
  test::write_text(file, "no HDF5");
  CHECK(error_of([&] {
          WritingRun(file).simulation.restore(saved);
        }).starts_with(file + ": cannot be opened as an HDF5 file"));
}

TEST_CASE("a folder that cannot be written is told before the first step", "[trajectory][messages]") {
  const test::ScratchFolder folder;
  test::write_text(folder / "file", "");
  const std::string file = (folder / "file/run.h5").string();
  WritingRun run(file);
  CHECK(error_of([&] { static_cast<void>(run.simulation.run(10)); }) ==
        file + ": cannot create the file: Not a directory");
  CHECK(run.simulation.step() == 0);
}

TEST_CASE("particles taken out of a run do not fit its trajectory any more", "[trajectory][messages]") {
  const test::ScratchFolder folder;
  WritingRun run(folder / "run.h5");
  REQUIRE(run.simulation.run(5).ok());
  run.simulation.edit([](ParticleSystem<double>& s) { s.remove(5); });
  CHECK(error_of([&] { static_cast<void>(run.simulation.run(5)); }) ==
        (folder / "run.h5").string() +
            ": the file has 6 particles, but the run now has 5, or others: a trajectory can contain only one set of "
            "particles; after an edit write another file");
}

TEST_CASE("a full disk ends the run with the file's name, and the program still ends well", "[trajectory][messages]") {
  const test::ScratchFolder folder;
  const std::string file = (folder / "run.h5").string();
  std::fflush(nullptr);
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    // A limit on the size of files stands for a full disk.
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{3'000'000, 3'000'000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    int status = 1;
    {
      WritingRun run(file);
      const std::string message = error_of([&] {
        while (run.simulation.run(100).ok()) run.writer->flush();
      });
      if (message.starts_with(file + ": cannot write") && message.ends_with(": File too large")) status = 0;
      if (status != 0) std::fprintf(stderr, "%s\n", message.c_str());
    }
    std::exit(status);
  }
  int status = -1;
  ::waitpid(child, &status, 0);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);

  // What was flushed is there and nothing else, and a run with room goes on with it.
  CHECK(io::verify(file).damaged.empty());
  const io::Frames frames = io::read_frames(file);
  REQUIRE(frames.frames.size() > 400);
  const std::int64_t last = frames.frames.back().step / 100 * 100;
  WritingRun whole(folder / "whole.h5"), resumed(file);
  REQUIRE(whole.simulation.run(last).ok());
  resumed.simulation.restore(whole.simulation.save());
  for (WritingRun* run : {&whole, &resumed}) {
    REQUIRE(run->simulation.run(50).ok());
    run->writer->finish(Outcome{});
  }
  test::check_same_content(folder / "whole.h5", file);
}

#else

TEST_CASE("a build without HDF5 says so before the first step", "[trajectory][messages]") {
  const test::ScratchFolder folder;
  const std::string file = (folder / "run.h5").string();
  WritingRun run(file);
  CHECK(error_of([&] { static_cast<void>(run.simulation.run(10)); }) ==
        file + ": this build has no HDF5: configure with -DNOETHER_HDF5=ON, or use the preset release");
  CHECK(run.simulation.step() == 0);
}

#endif

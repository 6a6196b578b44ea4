// What stands in a file: summaries, checks, conversions.

#include "io/inspect.hpp"

#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/bodies.hpp"
#include "io/digest.hpp"
#include "io/hdf5_file.hpp"
#include "io/structure.hpp"
#include "io/trajectory.hpp"
#include "numbers/quantity.hpp"
#include "numbers/version.hpp"
#include "tests/io/support.hpp"
#include "tests/support/drivers.hpp"

#include <sstream>

using namespace noether;
using test::error_of;
using test::WritingRun;

#if NOETHER_HDF5

namespace {

std::vector<std::string> lines_in(const std::filesystem::path& file) { return test::lines_of(test::read_text(file)); }

}  // namespace

TEST_CASE("info tells what a trajectory holds", "[inspect]") {
  const test::ScratchFolder folder;
  WritingRun run(folder / "run.h5");
  REQUIRE(run.simulation.run(33).ok());
  run.writer->finish(Outcome{});
  const io::FileInfo info = io::info(folder / "run.h5");
  CHECK(info.kind == "trajectory");
  CHECK(info.complete);
  CHECK(info.last_step == 30);
  CHECK(info.last_time == 30 * 40.0);
  CHECK(info.time_unit == "day");
  CHECK(info.particles == 6);
  CHECK(info.frames == 7);
  CHECK(info.version == version());
  CHECK(info.commit == commit());
  CHECK(info.simd == name(simd_level()));
  CHECK(info.units == "solar");
  CHECK(info.scene_toml == "title = \"outer planets\"\n");
  REQUIRE(info.monitors.size() == 2);
  CHECK(info.monitors[1].name == "energy");
  CHECK(info.monitors[1].samples == 12);
  CHECK(info.monitors[1].quantities == std::vector<std::string>{"kinetic", "potential", "relative_error", "total"});
}

TEST_CASE("info tells what a checkpoint holds", "[inspect]") {
  const test::ScratchFolder folder;
  WritingRun run(folder / "run.h5");
  run.simulation.every(10, io::CheckpointWriter(folder / "checkpoint.h5", "title = \"x\"\n"));
  REQUIRE(run.simulation.run(10).ok());
  const io::FileInfo info = io::info(folder / "checkpoint.h5");
  CHECK(info.kind == "checkpoint");
  CHECK(info.complete);
  CHECK(info.last_step == 10);
  CHECK(info.last_time == 400);
  CHECK(info.particles == 6);
  CHECK(info.digest == io::digest(run.simulation.particles()));
  CHECK(info.units == "solar");
  CHECK(info.time_unit == "day");
  CHECK(info.outcome.empty());
  CHECK(info.version == version());
}

TEST_CASE("info refuses what is no file of noether", "[inspect][messages]") {
  const test::ScratchFolder folder;
  const std::string file = (folder / "x.h5").string();
  CHECK(error_of([&] { io::info(file); }) == file + ": there is no such file");
  CHECK(error_of([&] { io::info(folder.path()); }) == folder.path().string() + ": this is not a regular file");
  test::write_text(file, "hello");
  CHECK(error_of([&] { io::info(file); }).starts_with(file + ": cannot be opened as an HDF5 file"));
  test::write_text(folder / "checkpoint.h5", "hello");
  CHECK(error_of([&] { io::info(folder / "checkpoint.h5"); }) ==
        (folder / "checkpoint.h5").string() +
            ": damaged, or not a checkpoint: the line 'sha256:...' at the end of its 5 bytes is missing");
}

TEST_CASE("verify finds nothing wrong with a good file, and names what is wrong with a bad one", "[inspect]") {
  const test::ScratchFolder folder;
  {
    WritingRun run(folder / "run.h5");
    run.simulation.every(20, io::CheckpointWriter(folder / "checkpoint.h5"));
    REQUIRE(run.simulation.run(60).ok());
    run.writer->finish(Outcome{});
  }
  CHECK(io::verify(folder / "run.h5").damaged.empty());
  CHECK(io::verify(folder / "checkpoint.h5").damaged.empty());
  CHECK(io::verify(folder / "checkpoint.h5").kind == "checkpoint");
  CHECK_THROWS_AS(io::verify(folder / "missing.h5"), FileError);

  const std::string checkpoint = test::read_text(folder / "checkpoint.h5");
  test::write_text(folder / "checkpoint.h5", checkpoint.substr(0, checkpoint.size() / 2));
  CHECK(io::verify(folder / "checkpoint.h5").damaged.size() == 1);

  if (!test::python_output("damage.py", {(folder / "run.h5").string()})) return;
  CHECK(io::verify(folder / "run.h5").damaged ==
        std::vector<std::string>{"'/particles/system/velocity/value' has 12 rows, others 11",
                                 "'/particles/system/position/step' has 13 rows, others 11",
                                 "'/particles/system/position/time' has 13 rows, others 11",
                                 "'/noether/digests/frames' has 13 rows, others 11", "frame 4 at step 20 is not finite",
                                 "frame 8 at step 5 does not have the digest that was written with it",
                                 "frames: step 5 follows step 35",
                                 "'/noether/monitors/energy/total' has 20 rows, its steps 21"});

  // Of a run that did not end well, only what is too short is damage.
  io::Hdf5File::open_to_append(folder / "run.h5").set_attribute("/noether", "complete", std::int64_t{0});
  CHECK(io::verify(folder / "run.h5").damaged ==
        std::vector<std::string>{
            "frame 4 at step 20 is not finite", "frame 8 at step 5 does not have the digest that was written with it",
            "frames: step 5 follows step 35", "'/noether/monitors/energy/total' has 20 rows, its steps 21"});
}

TEST_CASE("a trajectory converts to extended XYZ and to CSV, and the numbers read back", "[inspect]") {
  const test::ScratchFolder folder;
  WritingRun run(folder / "run.h5");
  REQUIRE(run.simulation.run(10).ok());
  run.writer->finish(Outcome{});
  const ParticleSystem<double>& last = run.simulation.particles();

  io::convert(folder / "run.h5", folder / "run.csv");
  const std::vector<std::string> csv = lines_in(folder / "run.csv");
  REQUIRE(csv.size() == 1 + 3 * 6);
  CHECK(csv[0] == "step,time [day],id,name,x [au],y [au],z [au],vx [au/day],vy [au/day],vz [au/day]");
  std::istringstream row(csv[14]);  // the last frame's Jupiter
  std::vector<std::string> fields;
  for (std::string field; std::getline(row, field, ',');) fields.push_back(field);
  REQUIRE(fields.size() == 10);
  CHECK(fields[0] == "10");
  CHECK(std::stod(fields[1]) == 400);
  CHECK(fields[2] == "1");
  CHECK(fields[3] == "Jupiter");
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(std::stod(fields[4 + k]) == last.positions()[1][static_cast<Index>(k)]);
    CHECK(std::stod(fields[7 + k]) == last.velocities()[1][static_cast<Index>(k)]);
  }

  io::convert(folder / "run.h5", folder / "run.xyz");
  const std::vector<std::string> xyz = lines_in(folder / "run.xyz");
  REQUIRE(xyz.size() == 3 * 8);
  CHECK(xyz[8] == "6");
  CHECK(xyz[9] ==
        "Properties=species:S:1:pos:R:3:vel:R:3 Time=200 Step=5 pbc=\"F F F\" units=solar length_unit=au "
        "velocity_unit=au/day time_unit=day");
  std::istringstream jupiter(xyz[16 + 3]);
  std::string species;
  double x = 0;
  jupiter >> species >> x;
  CHECK(species == "Jupiter");
  CHECK(x == last.positions()[1][0]);
}

TEST_CASE("the XYZ of a molecular run in a box reads back as its particles", "[inspect][structure]") {
  const test::ScratchFolder folder;
  ParticleSystem<double> water(unit_system("molecular"));
  water.set_box(Box::periodic({1.5, 2, 2.5}));
  water.add("O_1", 15.999, {0.1, 1.9, -0.3}, {0.5, -0.25, 3});
  water.add("H_2", 1.008, {0.17, 1.85, 2.6}, {-2, 1, 0.125});
  water.add("ion", 22.99, {0.7, 0.6, 0.5}, {0, 0, -1});
  Simulation<double> run(water, compose(test::kinetic_potential(), schemes::verlet), 0.001);
  auto& writer = run.every(1, io::TrajectoryWriter(folder / "run.h5"));
  REQUIRE(run.run(0).ok());
  writer.finish(Outcome{});
  io::convert(folder / "run.h5", folder / "run.xyz");
  CHECK(lines_in(folder / "run.xyz")[1] ==
        "Properties=species:S:1:pos:R:3:masses:R:1:momenta:R:3 Time=0 Step=0 Lattice=\"15 0 0 0 20 0 0 0 25\" "
        "pbc=\"T T T\" time_unit=ps");
  const ParticleSystem<double> back = io::read_structure(folder / "run.xyz");
  const ParticleSystem<double>& sent = run.particles();
  REQUIRE(back.size() == 3);
  CHECK((back.box().edges() - sent.box().edges()).norm() < 1e-15);
  CHECK(back.names() == std::vector<std::string>{"O_1", "H_2", "ion_3"});
  for (Index i = 0; i < 3; ++i) {
    CHECK(back.masses()[i] == sent.masses()[i]);
    CHECK((Vec3<double>(back.positions()[i]) - Vec3<double>(sent.positions()[i])).norm() < 1e-15);
    CHECK((Vec3<double>(back.velocities()[i]) - Vec3<double>(sent.velocities()[i])).norm() < 1e-15);
  }
}

TEST_CASE("positions of particles that cross the box are converted unwrapped where that is asked for", "[inspect]") {
  const test::ScratchFolder folder;
  ParticleSystem<double> gas(unit_system("molecular"));
  gas.set_box(Box::periodic({1.5, 2, 2.5}));
  gas.add("up", 1, {1.25, 1, 1}, {0.5, 0, 0});      // to 3.75: over one edge and then the next
  gas.add("down", 1, {1, 0.25, 2}, {0, -0.25, 1});  // to y = -1, z = 7
  Simulation<double> run(gas, compose(test::kinetic_potential(), schemes::verlet), 0.5);
  auto& writer = run.every(1, io::TrajectoryWriter(folder / "run.h5"));
  REQUIRE(run.run(10).ok());
  writer.finish(Outcome{});

  const auto position = [&](const std::string& file, std::size_t line, char separator, std::size_t first) {
    std::istringstream row(lines_in(folder / file).at(line));
    std::vector<std::string> fields;
    for (std::string field; std::getline(row, field, separator);) fields.push_back(field);
    return Vec3<double>(std::stod(fields.at(first)), std::stod(fields.at(first + 1)), std::stod(fields.at(first + 2)));
  };
  CHECK(io::convert(folder / "run.h5", folder / "run.csv", {.unwrapped = true}) == 11);
  io::convert(folder / "run.h5", folder / "wrapped.csv");
  io::convert(folder / "run.h5", folder / "run.xyz", {.unwrapped = true});
  for (std::size_t k = 0; k <= 10; ++k) {  // free flight: every number is exact
    const double t = 0.5 * static_cast<double>(k);
    const Vec3<double> up(1.25 + 0.5 * t, 1, 1), down(1, 0.25 - 0.25 * t, 2 + t);
    CHECK(position("run.csv", 1 + 2 * k, ',', 4) == up);
    CHECK(position("run.csv", 2 + 2 * k, ',', 4) == down);
    CHECK((position("run.xyz", 2 + 4 * k, ' ', 1) - 10 * up).norm() < 1e-14);
    CHECK((position("run.xyz", 3 + 4 * k, ' ', 1) - 10 * down).norm() < 1e-14);
  }
  CHECK(position("wrapped.csv", 21, ',', 4) == Vec3<double>(0.75, 1, 1));
  CHECK(position("wrapped.csv", 22, ',', 4) == Vec3<double>(1, 1, 2));
}

TEST_CASE("a conversion that cannot be is refused", "[inspect][messages]") {
  const test::ScratchFolder folder;
  CHECK(error_of([&] { io::convert(folder / "run.h5", "out.xyzz"); }) ==
        "cannot convert to 'out.xyzz': unknown extension '.xyzz'; did you mean '.xyz'?");
  CHECK(error_of([&] { io::convert(folder / "run.h5", "out.pdb"); }) ==
        "cannot convert to 'out.pdb': unknown extension '.pdb'; expected one of: .xyz, .csv, .vtu");
  CHECK(error_of([&] { io::convert(folder / "run.h5", folder / "out.csv"); }) ==
        (folder / "run.h5").string() + ": there is no such file");
  {
    WritingRun run(folder / "run.h5");
    REQUIRE(run.simulation.run(0).ok());
  }
  CHECK(error_of([&] { io::convert(folder / "run.h5", folder / "out.csv", {.unwrapped = true}); }) ==
        "cannot unwrap the positions of '" + (folder / "run.h5").string() +
            "': its frames have no periodic box; leave out --unwrapped");
  CHECK_FALSE(std::filesystem::exists(folder / "out.csv"));
  CHECK(error_of([&] { io::convert(folder / "run.h5", folder / "none/out.csv"); }) ==
        (folder / "none/out.csv").string() +
            ": cannot be written; check that the folder exists and the disk is not full");
}

#endif

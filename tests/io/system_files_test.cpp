// Files of first-order systems: frames, digests, checkpoints, cutting back.

#include "integrators/systems/heat_line.hpp"
#include "io/digest.hpp"
#include "io/hdf5_file.hpp"
#include "io/inspect.hpp"
#include "io/repair.hpp"
#include "tests/io/support.hpp"

using namespace noether;
using test::error_of;
using test::LorenzRun;

TEST_CASE("the digest of a system is what Python's hashlib computes from the same numbers", "[digest]") {
  // import hashlib, struct; hashlib.sha256(b'noether-system-1\n' + struct.pack('<qqd', 3, 4, 0.5 + 3 * 0.1) +
  //   struct.pack('<4d', .1, -0.0, 1e-300, 7)).hexdigest()
  ParticleSystem<double> s;
  s.set_variables({0.1, -0.0, 1e-300, 7});
  s.clock() = Clock<double>::fixed(0.5, 0.1, 3);
  CHECK(io::digest(s) == "sha256:a944f05be35b93391f5ca904c95d3a4d6a21c36e97416504b0afb7cf57bfe1eb");
  s.variables()[1] = 0;
  CHECK(io::digest(s) != "sha256:a944f05be35b93391f5ca904c95d3a4d6a21c36e97416504b0afb7cf57bfe1eb");
}

#if NOETHER_HDF5

TEST_CASE("h5py finds the frames of a system, and Python's digest of the last one is the run's", "[system_files]") {
  const test::ScratchFolder folder;
  LorenzRun run(folder / "run.h5");
  REQUIRE(run.simulation.run(100).ok());
  run.writer->finish(Outcome{});
  const std::string digest = io::digest(run.simulation.particles());
  const auto read = test::python_output("read_system.py", {(folder / "run.h5").string(), "21", "5", "0.0025", "x,y,z"});
  if (read) CHECK(*read == digest + "\n");
  const io::FileInfo info = io::verify(folder / "run.h5");
  CHECK(info.damaged.empty());
  CHECK(info.digest == digest);
  CHECK(info.complete);
  CHECK(info.particles == 0);
  CHECK(info.variables == 3);
  CHECK(info.frames == 21);
  CHECK(info.last_step == 100);
}

TEST_CASE("a system's run that goes on writes the file of a run that was never cut", "[system_files][restart]") {
  const test::ScratchFolder folder;
  LorenzRun whole(folder / "whole.h5");
  REQUIRE(whole.simulation.run(200).ok());
  whole.writer->finish(Outcome{});
  SavedRun saved;
  {
    LorenzRun first(folder / "run.h5");
    REQUIRE(first.simulation.run(77).ok());
    first.writer->flush();
    saved = first.simulation.save();
    REQUIRE(first.simulation.run(60).ok());
    first.writer->finish(Outcome{});
  }
  LorenzRun second(folder / "run.h5");
  second.simulation.restore(saved);
  REQUIRE(second.simulation.run(123).ok());
  second.writer->finish(Outcome{});
  test::check_same_content(folder / "whole.h5", folder / "run.h5");
  const io::Frames a = io::read_frames(folder / "whole.h5"), b = io::read_frames(folder / "run.h5");
  REQUIRE(a.frames.size() == 41);
  REQUIRE(b.frames.size() == 41);
  for (std::size_t k = 0; k < a.frames.size(); ++k) {
    CHECK(a.frames[k].step == b.frames[k].step);
    CHECK(a.frames[k].variables == b.frames[k].variables);
  }
}

TEST_CASE("a checkpoint carries variables, names and digest of a system", "[system_files][checkpoint]") {
  const test::ScratchFolder folder;
  LorenzRun run(folder / "run.h5");
  run.simulation.every(50, io::CheckpointWriter(folder / "checkpoint.h5"));
  REQUIRE(run.simulation.run(60).ok());
  const io::FoundCheckpoint found = io::newest_checkpoint(folder.path());
  REQUIRE(found.checkpoint);
  CHECK(found.checkpoint->step == 50);
  const io::FileInfo info = io::info(folder / "checkpoint.h5");
  CHECK(info.variables == 3);
  CHECK(info.particles == 0);
  const std::string digest = io::digest(run.simulation.particles());
  run.simulation.restore(found.checkpoint->run);
  CHECK(run.simulation.step() == 50);
  CHECK(io::digest(run.simulation.particles()) == found.checkpoint->digest);
  REQUIRE(run.simulation.run(10).ok());
  CHECK(io::digest(run.simulation.particles()) == digest);
}

TEST_CASE("variables without names are numbered, and a system without frames still tells how many there are",
          "[system_files]") {
  const test::ScratchFolder folder;
  const HeatLine line{.points = 4};
  Simulation run(initial_state(line), classical(line, method("rk4")), 1e-3);
  auto& writer = run.every(1, io::TrajectoryWriter(folder / "run.h5"));
  auto& bare = run.every(1, io::TrajectoryWriter(folder / "bare.h5", {.frames = false}));
  REQUIRE(run.run(2).ok());
  writer.flush();
  bare.flush();
  CHECK(io::read_frames(folder / "run.h5").variable_names == std::vector<std::string>{"y[0]", "y[1]", "y[2]", "y[3]"});
  CHECK(io::info(folder / "bare.h5").variables == 4);
  CHECK(io::info(folder / "bare.h5").frames == 0);
  CHECK(io::verify(folder / "bare.h5").damaged.empty());
}

TEST_CASE("frames of a system convert to CSV, and are refused as XYZ", "[system_files]") {
  const test::ScratchFolder folder;
  LorenzRun run(folder / "run.h5");
  REQUIRE(run.simulation.run(5).ok());
  run.writer->flush();
  CHECK(io::convert(folder / "run.h5", folder / "run.csv") == 2);
  const auto& y = run.simulation.particles().variables();
  CHECK(test::read_text(folder / "run.csv") ==
        fmt::format("step,time,x,y,z\n0,0,1,1,1\n5,{:.17g},{:.17g},{:.17g},{:.17g}\n", 5 * 0.25e-2, y[0], y[1], y[2]));
  const std::string xyz = (folder / "run.xyz").string();
  CHECK(error_of([&] { io::convert(folder / "run.h5", folder / "run.csv", {.unwrapped = true}); }) ==
        "cannot unwrap the positions of '" + (folder / "run.h5").string() +
            "': its frames have no periodic box; leave out --unwrapped");
  CHECK(error_of([&] { io::convert(folder / "run.h5", xyz); }) ==
        "cannot convert to '" + xyz + "': a first-order system has no particles; give a name that ends in .csv");
}

TEST_CASE("rows that a dead run of a system has left are cut off", "[system_files][repair]") {
  const test::ScratchFolder folder;
  {
    LorenzRun run(folder / "run.h5");
    REQUIRE(run.simulation.run(50).ok());
    run.writer->finish(Outcome{});
  }
  {
    const io::Hdf5File file = io::Hdf5File::open_to_append(folder / "run.h5");
    file.open("/noether/system/step").append(std::vector<std::int64_t>{55});
    file.open("/noether/system/time").append(std::vector<double>{55 * 0.25e-2});
    file.flush();
  }
  CHECK(io::verify(folder / "run.h5").damaged.size() == 2);
  const io::Repair mended = io::repair(folder / "run.h5");
  CHECK(mended.repaired.size() == 2);
  CHECK(mended.info.damaged.empty());
  CHECK(mended.info.frames == 11);
}

TEST_CASE("a system of another size does not go on with a file", "[system_files][messages]") {
  const test::ScratchFolder folder;
  LorenzRun run(folder / "run.h5");
  REQUIRE(run.simulation.run(5).ok());
  run.writer->flush();
  const SavedRun saved = run.simulation.save();
  const HeatLine line{.points = 4};
  Simulation other(initial_state(line), classical(line, method("rk4")), 0.25e-2);
  auto& writer = other.every(5, io::TrajectoryWriter(folder / "run.h5"));
  writer.load(saved.parts.at("trajectory"), "state");
  CHECK(error_of([&] {
          static_cast<void>(other.run(5));
        }).find("the file has 3 variables, but the run now has 4: a trajectory can contain only one system") !=
        std::string::npos);
}

#endif

// Two runs beside each other: where they first differ, across cadences, and what cannot be compared.

#include "io/compare_runs.hpp"

#include "tests/io/support.hpp"

#include <fmt/format.h>

#if NOETHER_HDF5

namespace noether::test {
namespace {

/// The outer planets under Verlet, written at cadences of one's own.
void write_planets(const std::filesystem::path& file, std::int64_t frames, std::int64_t samples, double start = 0,
                   double nudge = 0, std::int64_t nudged_at = 0) {
  Simulation<double> run(outer_planets(), compose(kinetic_potential(Gravity{.G = outer_G}), schemes::verlet), 32.0,
                         start);
  run.every(samples, Energy{});
  auto& writer = run.every(frames, io::TrajectoryWriter(file, {.scene_toml = "title = \"outer planets\"\n"}));
  if (nudge != 0) {
    REQUIRE(run.run(nudged_at).ok());
    run.edit([&](ParticleSystem<double>& s) {
      Vec3<double> x = s.positions()[2];
      x[1] *= 1 + nudge;
      s.positions().set(2, x);
    });
    REQUIRE(run.run(60 - nudged_at).ok());
  } else {
    REQUIRE(run.run(60).ok());
  }
  writer.finish(Outcome{});
}

const io::RowComparison& rows_of(const io::RunComparison& found, const std::string& name) {
  for (const io::RowComparison& one : found.rows) {
    if (one.name == name) return one;
  }
  throw LogicError("there is no " + name);
}

}  // namespace

TEST_CASE("runs of one scene at other cadences are the same at the moments that both have", "[compare runs]") {
  const ScratchFolder folder;
  write_planets(folder / "a.h5", 4, 3);
  write_planets(folder / "b.h5", 6, 5);
  const io::RunComparison found = io::compare_runs(folder / "a.h5", folder / "b.h5");
  CHECK(found.same());
  CHECK(found.constants.empty());
  CHECK(found.notes.empty());
  REQUIRE(found.rows.size() == 2);
  const io::RowComparison& frames = rows_of(found, "frames");
  CHECK(frames.compared == 6);  // steps 0, 12, ..., 60
  CHECK(frames.equal == 6);
  CHECK(frames.only_first == 10);
  CHECK(frames.only_second == 5);
  const io::RowComparison& energy = rows_of(found, "energy");
  CHECK(energy.compared == 5);  // steps 0, 15, ..., 60
  CHECK(energy.equal == 5);
  CHECK(energy.only_first == 16);
  CHECK(energy.only_second == 8);
}

TEST_CASE("a run is the same as itself", "[compare runs]") {
  const ScratchFolder folder;
  write_planets(folder / "a.h5", 4, 3);
  for (const io::MatchBy by : {io::MatchBy::time, io::MatchBy::step}) {
    const io::RunComparison found = io::compare_runs(folder / "a.h5", folder / "a.h5", by);
    CHECK(found.same());
    CHECK(rows_of(found, "frames").equal == 16);
    CHECK(rows_of(found, "energy").equal == 21);
  }
}

TEST_CASE("the first frame and the first sample that differ are named, to the number", "[compare runs]") {
  const ScratchFolder folder;
  write_planets(folder / "a.h5", 4, 3);
  write_planets(folder / "b.h5", 2, 1, 0, 1e-9, 20);
  const io::RunComparison found = io::compare_runs(folder / "a.h5", folder / "b.h5");
  CHECK_FALSE(found.same());
  const io::RowComparison& frames = rows_of(found, "frames");
  REQUIRE(frames.difference);
  // The edit comes after what was written of step 20: the next frame of both is that of step 24.
  CHECK(frames.difference->step == 24);
  CHECK(frames.difference->other_step == 24);
  CHECK(frames.difference->time == 24 * 32.0);
  CHECK(frames.difference->dataset == "position/value");
  CHECK(frames.difference->where.find(" of particle ") == 1);  // whichever it has pulled at
  CHECK(frames.difference->differing > 0);
  CHECK(frames.difference->numbers == 3 * outer_planets().size());
  CHECK(frames.difference->value != frames.difference->other_value);
  CHECK(frames.difference->largest > 1e-10);
  CHECK(frames.difference->largest < 1e-7);
  CHECK(frames.equal == 6);
  CHECK(frames.compared == 16);
  const io::RowComparison& energy = rows_of(found, "energy");
  REQUIRE(energy.difference);
  CHECK(energy.difference->step == 21);
  CHECK(energy.difference->numbers == 1);
  CHECK(energy.equal == 7);
}

TEST_CASE("runs from other starts are compared by step, whatever their times", "[compare runs]") {
  const ScratchFolder folder;
  write_planets(folder / "a.h5", 4, 3);
  write_planets(folder / "b.h5", 4, 3, 1e6);
  write_planets(folder / "c.h5", 4, 3, 1e6, 1e-9, 20);
  const io::RunComparison by_time = io::compare_runs(folder / "a.h5", folder / "b.h5");
  CHECK(by_time.compared() == 0);
  CHECK_FALSE(by_time.same());
  const io::RunComparison by_step = io::compare_runs(folder / "a.h5", folder / "b.h5", io::MatchBy::step);
  const io::RowComparison& frames = rows_of(by_step, "frames");
  CHECK(frames.compared == 16);
  CHECK(frames.equal == 16);
  CHECK(by_step.same());
  const io::RunComparison nudged = io::compare_runs(folder / "a.h5", folder / "c.h5", io::MatchBy::step);
  const io::RowComparison& other = rows_of(nudged, "frames");
  REQUIRE(other.difference);
  CHECK(other.difference->dataset == "position/value");
  CHECK(other.difference->step == 24);
  CHECK(other.difference->time == 24 * 32.0);
  CHECK(other.difference->other_time == 1e6 + 24 * 32.0);
}

TEST_CASE("other particles, other monitors and other scenes are told", "[compare runs]") {
  const ScratchFolder folder;
  write_planets(folder / "a.h5", 4, 3);
  {
    WritingRun run(folder / "b.h5", planets_with_tracers(3));
    REQUIRE(run.simulation.run(60).ok());
    run.writer->finish(Outcome{});
  }
  const io::RunComparison found = io::compare_runs(folder / "a.h5", folder / "b.h5");
  CHECK_FALSE(found.same());
  CHECK_FALSE(found.constants.empty());
  CHECK(rows_of(found, "frames").compared == 0);
  CHECK(rows_of(found, "frames").only_first == 16);
  CHECK(rows_of(found, "angular_momentum").only_second == 7);
  CHECK(rows_of(found, "energy").compared > 0);
  {
    LorenzRun run(folder / "c.h5", {.scene_toml = "title = \"c\"\n"});
    REQUIRE(run.simulation.run(20).ok());
    LorenzRun other(folder / "d.h5", {.scene_toml = "title = \"d\"\n"});
    REQUIRE(other.simulation.run(30).ok());
  }
  const io::RunComparison systems = io::compare_runs(folder / "c.h5", folder / "d.h5");
  CHECK(systems.same());
  CHECK(rows_of(systems, "frames").compared == 5);
  CHECK(rows_of(systems, "frames").only_second == 2);
  CHECK(systems.notes ==
        std::vector<std::string>{"scenes differ first in the lines 'title = \"c\"' and 'title = \"d\"'"});
  const io::RunComparison nothing = io::compare_runs(folder / "a.h5", folder / "c.h5");
  CHECK(nothing.compared() == 0);
  CHECK_FALSE(nothing.same());
}

TEST_CASE("rows of a method that chooses its steps are compared by step, several to a step", "[compare runs]") {
  const ScratchFolder folder;
  const auto write = [&](const std::string& name, double start, double interval, double nudge) {
    ParticleSystem<double> s = outer_planets();
    Vec3<double> x = s.positions()[2];
    x[1] *= 1 + nudge;
    s.positions().set(2, x);
    Simulation<double> run(std::move(s), classical_over(Gravity{.G = outer_G}, method("dop853")),
                           Clock<double>::free(start));
    auto& writer = run.every_time(interval, io::TrajectoryWriter(folder / name, {.scene_toml = "title = \"p\"\n"}));
    REQUIRE(run.run_until(start + 2560).ok());
    writer.finish(Outcome{});
  };
  write("a.h5", 0, 8, 0);
  write("b.h5", 0, 8, 0);
  write("c.h5", 0, 8, 1e-9);
  write("d.h5", 0, 4, 0);
  const io::RunComparison same = io::compare_runs(folder / "a.h5", folder / "b.h5", io::MatchBy::step);
  CHECK(same.same());
  CHECK(rows_of(same, "frames").compared == 321);
  CHECK(rows_of(same, "frames").equal == 321);
  CHECK(rows_of(same, "frames").only_first == 0);
  const io::RunComparison nudged = io::compare_runs(folder / "a.h5", folder / "c.h5", io::MatchBy::step);
  CHECK_FALSE(nudged.same());
  CHECK(rows_of(nudged, "frames").compared > 200);
  // Nothing tells which of two rows of a step is that of the other run: 2n of a step are left out beside n.
  const io::RunComparison closer = io::compare_runs(folder / "a.h5", folder / "d.h5", io::MatchBy::step);
  CHECK(rows_of(closer, "frames").compared < 10);
  CHECK(io::compare_runs(folder / "a.h5", folder / "d.h5").same());
}

}  // namespace noether::test

#endif

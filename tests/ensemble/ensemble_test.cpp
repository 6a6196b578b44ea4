// Ensembles: rows that depend on the member alone, made at once, in shards, or in pieces.

#include "study/ensemble.hpp"

#include "io/ensemble_journal.hpp"
#include "numbers/parallel.hpp"
#include "study/ensemble_member.hpp"
#include "tests/ensemble/support.hpp"
#include "tests/support/refusal.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace noether::test {
namespace {

const std::vector<std::string> axes = {"particles.body.c.a=1.2:1.8:5", "particles.body.c.e=0:1.05:4"};

/// The number of a row's column.
double value_of(const io::EnsembleTable& table, std::size_t row, const std::string& column, std::size_t at = 0) {
  std::size_t first = table.definition.keys.size();
  for (const io::EnsembleColumn& one : table.definition.columns) {
    if (one.name == column) return table.rows[row].values[first + at];
    first += static_cast<std::size_t>(one.width());
  }
  FAIL("there is no column " << column);
  return 0;
}

std::size_t count_of(const io::EnsembleTable& table, const std::string& outcome) {
  std::size_t count = 0;
  for (const io::EnsembleRow& row : table.rows) {
    count += table.definition.outcomes[static_cast<std::size_t>(row.outcome)] == outcome ? 1 : 0;
  }
  return count;
}

TEST_CASE("a row tells how its member has ended, by the figures of a run of the same scene", "[ensemble]") {
  const ScratchFolder folder;
  write_text(folder / "scene.toml", planets());
  const io::EnsembleTable table = rows_of(folder, plan_of(axes), "map.h5");
  REQUIRE(table.rows.size() == 20);
  CHECK(count_of(table, "refused") == 5);  // e = 1.05 does not fit a > 0
  CHECK(count_of(table, "stopped") > 0);
  CHECK(count_of(table, "completed") > 0);
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    const io::EnsembleRow& row = table.rows[k];
    CHECK(row.member == static_cast<std::int64_t>(k));
    if (row.outcome == std::ssize(table.definition.outcomes) - 1) {
      CHECK(std::isnan(value_of(table, k, "energy_worst")));
      CHECK(row.digest == io::RowDigest{});
      continue;
    }
    // The run by itself is the oracle: other code advances it where members go in lanes.
    Simulation<double> sim = assemble(load_scene(
        folder / "scene.toml", standard_parts(),
        {fmt::format("particles.body.c.a={}", row.values[0]), fmt::format("particles.body.c.e={}", row.values[1])}));
    const Outcome outcome = sim.run(200);
    CHECK(row.outcome == static_cast<std::int64_t>(outcome.kind));
    CHECK(row.step == outcome.step);
    CHECK(row.time == outcome.time);
    CHECK(row.particle == (outcome.particle ? outcome.particle->id : -1));
    if (row.values[0] < 1.4) continue;  // close encounters tell roundings apart
    sim.for_each_monitor([&](const std::string& name, AnyMonitor<double>& monitor) {
      if (name != "energy") return;
      CHECK(std::abs(value_of(table, k, "energy_worst") - *monitor.report()->worst) <= 1e-14);
    });
    for (Index i = 0; i < 3; ++i) {
      for (int c = 0; c < 3; ++c) {
        const double x = sim.particles().positions()[i][c];
        CHECK(std::abs(value_of(table, k, "position", static_cast<std::size_t>(3 * i + c)) - x) <= 1e-11);
      }
    }
  }
}

TEST_CASE("rows have the same bits in any company, by any number of threads", "[ensemble]") {
  const ScratchFolder folder;
  write_text(folder / "scene.toml", planets());
  const io::EnsembleTable whole = rows_of(folder, plan_of(axes), "whole.h5");
  const int threads = thread_count();
  set_thread_count(1);
  check_same_rows(rows_of(folder, plan_of(axes), "one_thread.h5").rows, whole.rows);
  set_thread_count(3);
  check_same_rows(rows_of(folder, plan_of(axes), "three_threads.h5").rows, whole.rows);
  set_thread_count(threads);
  for (std::int64_t k = 0; k < 20; k += 3) {  // alone: one member is a shard
    check_same_rows(rows_of(folder, plan_of(axes), "alone.h5", {.shard = {k, 20}}).rows,
                    {whole.rows[static_cast<std::size_t>(k)]});
  }
}

TEST_CASE("members whose neighbours have other steps or forces go one by one", "[ensemble][lanes]") {
  const ScratchFolder folder;
  write_text(folder / "scene.toml", planets());
  const std::string step = "integrator.step=0.05:0.1:2", axis = "particles.body.c.a=1.6:1.8:2";
  CHECK_FALSE(rows_of(folder, plan_of({axis, step}), "by_steps.h5").definition.in_lanes);
  CHECK(rows_of(folder, plan_of({step, axis}), "by_axes.h5").definition.in_lanes);
  CHECK_FALSE(rows_of(folder, plan_of({axis, "integrator.step=uniform(0.05,0.1)"}, 2), "drawn.h5").definition.in_lanes);
}

TEST_CASE("shards are put together to the bytes of one file, for any number of them", "[ensemble]") {
  const ScratchFolder folder;
  write_text(folder / "scene.toml", planets());
  rows_of(folder, plan_of(axes), "whole.h5");
  const std::string bytes = read_text(folder / "whole.h5");
  for (const std::int64_t shards : {1, 2, 3, 7, 20}) {
    CAPTURE(shards);
    std::vector<std::filesystem::path> files;
    for (std::int64_t k = 0; k < shards; ++k) {
      rows_of(folder, plan_of(axes), "part.h5", {.shard = {k, shards}});
      files.insert(files.begin(), shard_file(folder / "part.h5", {k, shards}));  // in any order
    }
    io::write_ensemble(folder / "merged.h5", io::merge_ensembles(files));
    CHECK(read_text(folder / "merged.h5") == bytes);
    for (const std::filesystem::path& file : files) std::filesystem::remove(file);
  }
}

TEST_CASE("an ensemble that was interrupted goes on to the bytes of one that was not", "[ensemble]") {
  const ScratchFolder folder;
  write_text(folder / "scene.toml", planets());
  rows_of(folder, plan_of(axes), "whole.h5");
  const std::filesystem::path file = folder / "part.h5", rows = io::ensemble_journal_of(file);
  std::atomic<bool> stop{false};
  EnsembleOptions options{.out = file};
  options.stop = &stop;
  options.progress = [&](const Share& share) { stop = share.row >= 5; };
  const EnsembleReport report = run_ensemble(folder / "scene.toml", plan_of(axes), options);
  CHECK(report.interrupted);
  CHECK(report.file.empty());
  CHECK((report.rows >= 5 && report.rows < 20));
  CHECK_FALSE(std::filesystem::exists(file));
  // A kill may tear the last row.
  const std::string bytes = read_text(rows);
  write_text(rows, bytes.substr(0, bytes.size() - 5));
  options.stop = nullptr;
  const EnsembleReport resumed = run_ensemble(folder / "scene.toml", plan_of(axes), options);
  CHECK(resumed.done_before == report.rows - 1);
  CHECK(resumed.rows == 20);
  CHECK(read_text(file) == read_text(folder / "whole.h5"));
  CHECK_FALSE(std::filesystem::exists(rows));
  // Finished: nothing is made again.
  const EnsembleReport again = run_ensemble(folder / "scene.toml", plan_of(axes), options);
  CHECK(again.done_before == 20);
  CHECK(again.digest == resumed.digest);
}

TEST_CASE("rows with a changed byte are made again", "[ensemble]") {
  const ScratchFolder folder;
  write_text(folder / "scene.toml", planets());
  const EnsembleScene scene(folder / "scene.toml", plan_of(axes), {}, true, standard_parts());
  const std::filesystem::path file = folder / "x.rows";
  {
    io::EnsembleJournal journal(file, scene.definition(), false);
    for (std::int64_t k = 0; k < 4; ++k) journal.append(scene.refused(k));
    CHECK(refusal_of([&] { io::EnsembleJournal(file, scene.definition(), false); }) ==
          "another process makes this ensemble; wait for it, or give another file with --out");
  }
  std::string bytes = read_text(file);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write_text(file, bytes);
  CHECK(io::EnsembleJournal(file, scene.definition(), false).rows().size() < 4);
  const EnsembleScene other(folder / "scene.toml", plan_of({"particles.body.c.a=1.2:1.8:6"}), {}, true,
                            standard_parts());
  CHECK(has(refusal_of([&] { io::EnsembleJournal(file, other.definition(), false); }), "rows of another ensemble"));
  CHECK(io::EnsembleJournal(file, other.definition(), true).rows().empty());
}

TEST_CASE("shards that do not belong together are refused in a line", "[ensemble]") {
  const ScratchFolder folder;
  write_text(folder / "scene.toml", planets());
  const auto make = [&](const EnsemblePlan& plan, const std::string& name, const io::EnsembleShard& shard) {
    rows_of(folder, plan, name, {.shard = shard});
    return shard_file(folder / name, shard);
  };
  const auto a0 = make(plan_of(axes), "a.h5", {0, 3}), a1 = make(plan_of(axes), "a.h5", {1, 3});
  const auto half = make(plan_of(axes), "a.h5", {1, 2}), other = make(plan_of({axes[0]}), "b.h5", {1, 3});
  const auto refusal = [](const std::vector<std::filesystem::path>& files) {
    return refusal_of([&] { static_cast<void>(io::merge_ensembles(files)); });
  };
  CHECK(refusal({a0, a1}) == "of 3 shards 2 is missing; run it first, by --shard 2/3");
  CHECK(refusal({a0}) == "of 3 shards 1, 2 are missing; run them first, by --shard 1/3");
  CHECK(has(refusal({a0, a0, a1}), "it is shard 0 of 3, and so is "));
  CHECK(has(refusal({a0, half}), "it is one of 2 shards, but "));
  CHECK(has(refusal({a0, other}), "it is not of the ensemble of "));
  CHECK(has(refusal({folder / "scene.toml"}), "a file of a run is expected"));
  EnsembleOptions wrong{.out = folder / "c.h5"};
  wrong.shard = {5, 4};
  CHECK(refusal_of([&] { run_ensemble(folder / "scene.toml", plan_of(axes), wrong); }) ==
        "there is no shard 5 of 4; they are 0/4 to 3/4");
}

TEST_CASE("a file of something else is never replaced, one of another ensemble only where that is asked for",
          "[ensemble]") {
  const ScratchFolder folder;
  write_text(folder / "scene.toml", planets());
  const EnsemblePlan plan = plan_of({axes[0]});
  EnsembleOptions options{.out = folder / "scene.toml"};
  options.fresh = true;
  CHECK(has(refusal_of([&] { run_ensemble(folder / "scene.toml", plan, options); }), "not that of an ensemble"));
  rows_of(folder, plan_of(axes), "map.h5");
  options = {.out = folder / "map.h5"};
  CHECK(
      has(refusal_of([&] { run_ensemble(folder / "scene.toml", plan, options); }), "the file is of another ensemble"));
  options.fresh = true;
  CHECK(run_ensemble(folder / "scene.toml", plan, options).rows == 5);
}

TEST_CASE("methods that choose their steps and systems of first order have rows too", "[ensemble]") {
  const ScratchFolder folder;
  write_text(folder / "scene.toml",
             "units = \"reduced\"\n[system]\ntype = \"lorenz\"\n[integrator]\nmethod = \"dop853\"\nuntil = 2\n");
  const io::EnsembleTable table = rows_of(folder, plan_of({"system.rho=normal(28,2)"}, 6, 3), "draws.h5");
  REQUIRE(table.rows.size() == 6);
  for (std::size_t k = 0; k < 6; ++k) {
    CHECK(table.rows[k].time == 2);
    CHECK(std::isfinite(value_of(table, k, "variables", 2)));
  }
  CHECK(value_of(table, 0, "variables") != value_of(table, 1, "variables"));
}

}  // namespace
}  // namespace noether::test

#include "study/ensemble.hpp"

#include "io/ensemble_journal.hpp"
#include "io/files.hpp"
#include "numbers/error.hpp"
#include "numbers/parallel.hpp"
#include "numbers/text.hpp"
#include "scene/json.hpp"
#include "scene/output_folder.hpp"
#include "scene/signals.hpp"
#include "study/ensemble_lanes.hpp"
#include "study/ensemble_member.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>
#include <mutex>
#include <set>
#include <span>
#include <utility>

namespace noether {

namespace {

namespace fs = std::filesystem;

/// Makes the members that are missing, on all threads.
class Driver {
 public:
  Driver(const EnsembleScene& scene, io::EnsembleJournal& journal, const EnsembleOptions& options,
         const std::atomic<bool>* stop)
      : scene_(scene), journal_(journal), options_(options), stop_(stop) {}

  /// @throws what a member throws that is no wrong scene, and what the journal throws
  void make(const std::vector<std::int64_t>& members) {
    wanted_ = std::ssize(members);
    members_ = &members;
    at_once_ = scene_.definition().in_lanes ? 8 : 1;
    const auto batches = static_cast<Index>((members.size() + at_once_ - 1) / at_once_);
    detail::share_blocks(
        batches, [](const void* self, Index k) noexcept { static_cast<const Work*>(self)->driver->make_batch(k); },
        &work_);
    if (thrown_) std::rethrow_exception(thrown_);
  }
  const std::string& refusal() const { return refusal_; }
  bool interrupted() const { return interrupted_.load(); }

 private:
  struct Work {
    Driver* driver;
  };

  void make_batch(Index k) noexcept {
    if (over_.load(std::memory_order_relaxed)) return;
    if (stop_ != nullptr && stop_->load(std::memory_order_relaxed)) return interrupt();
    try {
      const std::size_t first = static_cast<std::size_t>(k) * at_once_;
      const std::size_t count = std::min(at_once_, members_->size() - first);
      for (EnsembleMember& one :
           run_members(scene_, std::span(*members_).subspan(first, count), scene_.definition().in_lanes, stop_)) {
        one.row ? keep(std::move(*one.row), one.refusal) : interrupt();
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!thrown_) thrown_ = std::current_exception();
      over_ = true;
    }
  }
  void interrupt() {
    interrupted_ = true;
    over_ = true;
  }
  void keep(io::EnsembleRow row, const std::string& refusal) {
    const std::lock_guard lock(mutex_);
    // Of several the first by number, whichever comes first.
    if (!refusal.empty() && (refusal_.empty() || row.member < refused_)) refusal_ = refusal, refused_ = row.member;
    journal_.append(std::move(row));
    if (!options_.progress) return;
    ++done_;
    options_.progress({.row = static_cast<int>(std::min<std::int64_t>(done_, std::numeric_limits<int>::max())),
                       .rows = static_cast<int>(std::min<Index>(wanted_, std::numeric_limits<int>::max())),
                       .done = static_cast<double>(done_) / static_cast<double>(wanted_),
                       .what = ""});
  }

  const EnsembleScene& scene_;
  io::EnsembleJournal& journal_;
  const EnsembleOptions& options_;
  const std::atomic<bool>* stop_;
  const std::vector<std::int64_t>* members_ = nullptr;
  Work work_{this};
  Index wanted_ = 0;
  std::size_t at_once_ = 1;
  std::mutex mutex_;
  std::atomic<bool> over_{false}, interrupted_{false};
  std::exception_ptr thrown_;
  std::string refusal_;
  std::int64_t refused_ = 0, done_ = 0;
};

/// The table that a file holds already, if it is this one. @throws SceneError  for a file of something else
io::EnsembleTable finished_table(const fs::path& file, const io::EnsembleDefinition& definition,
                                 const io::EnsembleShard& shard) {
  io::EnsembleTable table;
  try {
    table = io::read_ensemble(file);
  } catch (const FileError& error) {
    throw SceneError(fmt::format("{}; give another file with --out, or --fresh to replace it", error.message()),
                     {.file = file.string()});
  }
  if (table.definition.digest() != definition.digest()) {
    throw SceneError(fmt::format("the file is of another ensemble: {}; give another one with --out, or --fresh to "
                                 "replace it",
                                 io::difference_of(table.definition, definition)),
                     {.file = file.string()});
  }
  if (table.shard.shards != shard.shards || table.shard.shard != shard.shard) {
    throw SceneError(fmt::format("the file is shard {} of {}, not {} of {}; give another one with --out",
                                 table.shard.shard, table.shard.shards, shard.shard, shard.shards),
                     {.file = file.string()});
  }
  return table;
}

/// Whether members that follow each other have one make: lanes share the method, the step and the forces.
bool neighbors_are_alike(const EnsemblePlan& plan) {
  const std::vector<std::string> keys = plan.fastest_keys();
  return std::all_of(keys.begin(), keys.end(), [](const std::string& key) {
    return key.starts_with("particles.") || key.starts_with("stop.") || key.starts_with("every.");
  });
}

void check_shard(const io::EnsembleShard& shard) {
  if (shard.shards >= 1 && shard.shard >= 0 && shard.shard < shard.shards) return;
  throw Error(shard.shards < 1 ? fmt::format("there are no {} shards; 1 or more are expected", shard.shards)
                               : fmt::format("there is no shard {0} of {1}; they are 0/{1} to {2}/{1}", shard.shard,
                                             shard.shards, shard.shards - 1));
}

void count_outcomes(EnsembleReport& report, const io::EnsembleDefinition& definition,
                    const std::vector<io::EnsembleRow>& rows) {
  report.rows = std::ssize(rows);
  report.outcomes = io::outcomes_of(definition, rows);
}

EnsembleReport make_rows(const EnsembleScene& scene, const fs::path& file, const EnsembleOptions& options,
                         EnsembleReport report) {
  const io::EnsembleDefinition& definition = scene.definition();
  const io::EnsembleShard& shard = options.shard;
  if (file.has_parent_path()) io::make_folder(file.parent_path());
  io::EnsembleJournal journal(io::ensemble_journal_of(file), definition, options.fresh);
  std::set<std::int64_t> there;
  for (const io::EnsembleRow& row : journal.rows()) there.insert(row.member);
  report.done_before = std::ssize(there);
  std::vector<std::int64_t> missing;
  for (std::int64_t k = shard.shard; k < definition.members; k += shard.shards) {
    if (!there.contains(k)) missing.push_back(k);
  }
  std::optional<StopOnSignals> signals;
  Driver driver(scene, journal, options, options.handle_signals ? signals.emplace().flag() : options.stop);
  const auto begin = std::chrono::steady_clock::now();
  driver.make(missing);
  report.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  report.refusal = driver.refusal();
  report.interrupted = driver.interrupted();
  count_outcomes(report, definition, journal.rows());
  if (report.interrupted) return report;
  io::EnsembleTable table{definition, shard, journal.rows()};
  std::sort(table.rows.begin(), table.rows.end(), [](const auto& a, const auto& b) { return a.member < b.member; });
  io::write_ensemble(file, table);
  journal.remove();
  report.file = file;
  report.digest = table.digest();
  return report;
}

}  // namespace

fs::path default_ensemble_file(const fs::path& scene) {
  return default_output_folder(scene).replace_extension(".ensemble.h5");
}

fs::path shard_file(const fs::path& file, const io::EnsembleShard& shard) {
  return shard.whole() ? file : fs::path(fmt::format("{}.{}-of-{}", file.string(), shard.shard, shard.shards));
}

EnsembleReport run_ensemble(const fs::path& scene_file, const EnsemblePlan& plan, const EnsembleOptions& options,
                            const Parts& parts) {
  check_shard(options.shard);
  const bool in_lanes = options.in_lanes && neighbors_are_alike(plan);
  const EnsembleScene scene(scene_file, plan, options.sets, in_lanes, parts);
  const io::EnsembleDefinition& definition = scene.definition();
  const fs::path file =
      shard_file(options.out.empty() ? default_ensemble_file(scene_file) : options.out, options.shard);
  EnsembleReport report;
  report.scene = scene_file.string();
  report.shard = options.shard;
  report.members = definition.members;
  report.wanted = options.shard.count(definition.members);
  report.simd = definition.simd;
  report.threads = thread_count();
  report.notes = scene.notes();
  if (!file.has_filename() || fs::is_directory(file)) {
    throw SceneError("this is a folder, and a file is expected; give one with --out", {.file = file.string()});
  }
  if (fs::exists(file) && !io::holds_ensemble(file)) {
    throw SceneError("the file is there already, and it is not that of an ensemble; give another one with --out",
                     {.file = file.string()});
  }
  const bool there = fs::exists(file) && !options.fresh;
  if (there) {
    const io::EnsembleTable table = finished_table(file, definition, options.shard);
    count_outcomes(report, definition, table.rows);
    report.done_before = report.rows;
    report.file = file;
    report.digest = table.digest();
    return report;
  }
  return make_rows(scene, file, options, std::move(report));
}

std::string to_json(const EnsembleReport& r) {
  Json::Members outcomes;
  for (const auto& [name, count] : r.outcomes) outcomes.emplace_back(name, count);
  Json::Members members = {{"schema", "noether.ensemble/1"},
                           {"scene", r.scene},
                           {"file", r.file.empty() ? Json() : Json(r.file.string())},
                           {"shard", r.shard.shard},
                           {"shards", r.shard.shards},
                           {"members", r.members},
                           {"wanted", r.wanted},
                           {"done", r.rows},
                           {"done_before", r.done_before},
                           {"outcomes", Json::object(outcomes)},
                           {"refusal", r.refusal.empty() ? Json() : Json(r.refusal)},
                           {"interrupted", r.interrupted},
                           {"threads", r.threads},
                           {"simd", r.simd},
                           {"wall_s", r.wall_s},
                           {"digest", r.digest.empty() ? Json() : Json(r.digest)}};
  if (!r.notes.empty()) members.emplace_back("notes", Json::list_of(r.notes));
  return Json::object(members).text();
}

std::string to_text(const EnsembleReport& r) {
  std::string text = r.shard.whole()
                         ? counted(r.rows, "member")
                         : fmt::format("shard {} of {}: {}", r.shard.shard, r.shard.shards, counted(r.rows, "member"));
  if (r.rows < r.wanted) text += fmt::format(" of {}", r.wanted);
  std::string how;
  for (const auto& [name, count] : r.outcomes) how += fmt::format("{}{} {}", how.empty() ? ": " : ", ", count, name);
  text += how + "\n";
  if (!r.refusal.empty()) text += fmt::format("refused: {}\n", r.refusal);
  const std::int64_t made = r.rows - r.done_before;
  if (r.done_before > 0)
    text += fmt::format("{} of them {} there already\n", r.done_before, r.done_before == 1 ? "was" : "were");
  if (made > 0 && r.wall_s > 0) {
    text += fmt::format("{} in {:.3g} s: {:.3g} a second on {}\n", counted(made, "member"), r.wall_s,
                        static_cast<double>(made) / r.wall_s, counted(r.threads, "thread"));
  }
  if (!r.file.empty()) text += fmt::format("{}{}\n{}\n", made > 0 ? "wrote " : "", r.file.string(), r.digest);
  return text;
}

}  // namespace noether

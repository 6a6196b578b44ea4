#pragma once
/// `noether ensemble`: many runs of one scene with other values, as rows of one table.

#include "io/ensemble_file.hpp"
#include "numbers/progress.hpp"
#include "scene/scene.hpp"
#include "study/variation.hpp"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// How an ensemble is made.
struct EnsembleOptions {
  std::filesystem::path out = {};      ///< empty: `default_ensemble_file`; a shard has its number behind it
  io::EnsembleShard shard = {};        ///< members that are made here
  bool in_lanes = true;                ///< eight members side by side where the scene can; false: each by itself
  bool fresh = false;                  ///< what is there of this or another ensemble is discarded
  bool handle_signals = false;         ///< SIGINT and SIGTERM end it; what is done is kept
  std::vector<std::string> sets = {};  ///< changes of the scene beside what varies
  TellShare progress = {};
  const std::atomic<bool>* stop = nullptr;  ///< ends it likewise, where signals are not handled here
};

/// What has become of an ensemble, or of a shard of it.
struct EnsembleReport {
  std::string scene;
  std::filesystem::path file;  ///< that was written; empty where members are missing
  io::EnsembleShard shard;
  std::int64_t members = 0, rows = 0;            ///< of the ensemble; done of those that belong here
  std::int64_t wanted = 0, done_before = 0;      ///< that belong here; of `rows`, those that were there already
  std::map<std::string, std::int64_t> outcomes;  ///< how often
  std::string refusal;                           ///< of the first member that could not be made: what is wrong with it
  std::string digest;                            ///< of all rows; empty where members are missing
  std::string simd;
  int threads = 1;
  double wall_s = 0;  ///< of the members made here
  bool interrupted = false;
  std::vector<std::string> notes = {};  ///< what of the scene was taken otherwise than written, and its warnings
};

/// The file of an ensemble unless told, in the working directory: NAME.ensemble.h5 (`default_output_folder`).
std::filesystem::path default_ensemble_file(const std::filesystem::path& scene);

/// The file of a shard: FILE itself where there is one shard, else FILE.2-of-8.
std::filesystem::path shard_file(const std::filesystem::path& file, const io::EnsembleShard& shard);

/// Makes the members of an ensemble that are not there yet, and writes its file when all are done.
///
/// A member is the scene with `VariedKeys::sets` of its values. It runs to the end of the scene or stops by itself;
/// its row has how it ended, the figures of its monitors (`MonitorReport` and what they saw last), the state at its end
/// and its digest. Rows depend on the member alone: not on threads, shards, or on what was made before. Members that
/// fail, or whose scene cannot be read, are rows as well.
///
/// Until all are done rows stand in FILE.rows (`io::EnsembleJournal`), where the next call goes on, whatever ended
/// this one.
/// @throws SceneError  for a scene that cannot be read with the first values of what varies, one without an end, and
///   a file of something else; FileError
EnsembleReport run_ensemble(const std::filesystem::path& scene, const EnsemblePlan& plan,
                            const EnsembleOptions& options = {}, const Parts& parts = standard_parts());

/// As one line of JSON: the schema noether.ensemble/1.
std::string to_json(const EnsembleReport& report);
/// As a few lines.
std::string to_text(const EnsembleReport& report);

}  // namespace noether

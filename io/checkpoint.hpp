#pragma once
/// Checkpoints: a whole run in one file, exact, with a hash over every byte.

#include "engine/description.hpp"
#include "engine/monitor.hpp"
#include "engine/saved_state.hpp"
#include "numbers/simd.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace noether::io {

/// What a checkpoint file holds.
struct Checkpoint {
  SavedRun run;
  std::string scene_toml;                              ///< effective scene; empty if the run was made by a program
  std::string digest;                                  ///< of the settled state, "sha256:<hex>"
  std::string simd = std::string(name(simd_level()));  ///< level of the lane kernels
  std::string outcome;                                 ///< how the run ended; empty while it is unfinished
  std::int64_t step = 0;
  double time = 0;  ///< [time]
};

/// Writes a checkpoint so that at any moment a valid one is on disk.
///
/// The new file is written beside and flushed to disk, an existing `checkpoint.h5` is renamed to
/// `checkpoint.previous.h5`, the new one takes its place, and the folder is flushed. After the HDF5 data, which opens
/// as any other, stands a line "sha256:<hex>" over all bytes before it.
/// @throws FileError
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

/// Reads a checkpoint; any changed or missing byte is noticed.
/// @throws FileError naming the file and what is damaged
Checkpoint read_checkpoint(const std::filesystem::path& file);

/// Whether a file ends as checkpoints do; its content is not looked at.
/// @throws never
bool ends_like_checkpoint(const std::filesystem::path& file);

/// The name the generation before goes by: checkpoint.h5 -> checkpoint.previous.h5.
std::filesystem::path previous_checkpoint(const std::filesystem::path& file);

struct FoundCheckpoint {
  std::optional<Checkpoint> checkpoint;  ///< the newest valid one
  std::vector<std::string> damaged;      ///< one line for each file that is there and not valid: "FILE: what"
};

/// Looks for `checkpoint.h5` and `checkpoint.previous.h5` in a folder.
/// @throws never for damaged files: they are listed
FoundCheckpoint newest_checkpoint(const std::filesystem::path& folder);

/// Writes checkpoints of a run: `sim.every(1'000, io::CheckpointWriter{"checkpoint.h5"})`.
class CheckpointWriter {
 public:
  /// @param beside  parts that are kept with those of the run, by name
  explicit CheckpointWriter(std::filesystem::path file, std::string scene_toml = {},
                            std::map<std::string, SavedState> beside = {})
      : file_(std::move(file)), scene_toml_(std::move(scene_toml)), beside_(std::move(beside)) {}

  static constexpr auto describe() {
    return part<CheckpointWriter>("checkpoint", "the whole run, so that it can be resumed",
                                  quantities("raw state of the particles, state of every part, the scene, a digest"));
  }
  /// Every other monitor has looked at this moment, and its files are flushed.
  static constexpr bool looks_last = true;

  void observe(const Snapshot<double>& now);

 private:
  std::filesystem::path file_;
  std::string scene_toml_;
  std::map<std::string, SavedState> beside_;
};

}  // namespace noether::io

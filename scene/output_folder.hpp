#pragma once
/// The folder a run writes to: locked while in use, kept when finished, never overwritten by accident.

#include "io/checkpoint.hpp"
#include "io/output_folder_name.hpp"

#include <filesystem>
#include <optional>

namespace noether {

/// What to do with what an earlier run has left.
enum class Existing : std::uint8_t {
  keep,    ///< move a finished run away; refuse to touch an unfinished one
  resume,  ///< go on from the newest valid checkpoint
  fresh,   ///< discard an unfinished run
};

using io::default_output_folder;

/// The output folder of one run. It is locked from construction to destruction.
class OutputFolder {
 public:
  /// Makes the folder and locks it.
  /// @throws SceneError if another run uses it; FileError if it cannot be made
  explicit OutputFolder(std::filesystem::path path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Makes room for a new run, or finds where to go on.
  /// @return the checkpoint to go on from; empty: start from the beginning
  /// @throws SceneError for an unfinished run with `keep`; FileError if there are only damaged checkpoints to resume
  std::optional<io::Checkpoint> prepare(Existing existing);

  /// Where `prepare` has moved a finished run; empty if there was none.
  const std::filesystem::path& moved_to() const { return moved_to_; }
  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path trajectory() const { return path_ / "run.h5"; }
  std::filesystem::path checkpoint() const { return path_ / "checkpoint.h5"; }

 private:
  bool has_files() const;
  void move_away();
  void discard() const;

  std::filesystem::path path_, moved_to_;
  int lock_ = -1;
};

}  // namespace noether

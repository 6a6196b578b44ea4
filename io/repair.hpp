#pragma once
/// Mends what a dead run or a failing disk has left of a trajectory: `noether verify --repair`.

#include "io/inspect.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace noether::io {

struct Repair {
  FileInfo info;                      ///< of the file as it is now; `damaged` lists what could not be mended
  std::vector<std::string> repaired;  ///< what was done, one line each
};

/// Mends a trajectory as far as that can be done; nobody may be writing to it.
///
/// The frames, and the samples of each monitor, are cut back to the last that is whole in every dataset. Where a dead
/// run left some datasets longer than others, that is done in the file itself, which is at every moment as before or as
/// after. Where the end of the file is missing, it is done on a copy, which takes the file's place if it is sound then;
/// the file as it was stays beside as FILE.damaged. What has lost more than frames and samples is not touched, nor is
/// what is no trajectory: of a damaged checkpoint --resume takes the one before.
/// @throws FileError if there is no such file, or it cannot be written
/// @cost as verify(), up to three times; room for a copy where the end is missing
Repair repair(const std::filesystem::path& file);

}  // namespace noether::io

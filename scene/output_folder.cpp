#include "scene/output_folder.hpp"

#include "io/files.hpp"
#include "numbers/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace noether {

namespace fs = std::filesystem;

namespace {

/// In the order they are moved away: the newest checkpoint, which says that the run is finished, comes last.
constexpr std::array<const char*, 3> run_files = {"run.h5", "checkpoint.previous.h5", "checkpoint.h5"};

io::FoundCheckpoint find_checkpoint(const fs::path& folder) {
#if NOETHER_HDF5
  return io::newest_checkpoint(folder);
#else
  static_cast<void>(folder);
  return {};
#endif
}

}  // namespace

OutputFolder::OutputFolder(fs::path path) : path_(std::move(path)) {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error && !fs::is_directory(path_)) {
    throw FileError(fmt::format("the output folder cannot be made: {}", error.message()), {.file = path_.string()});
  }
  lock_ = ::open((path_ / ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock_ < 0) {
    throw FileError(fmt::format("the output folder cannot be written: {}", std::strerror(errno)),
                    {.file = path_.string()});
  }
  if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    const int reason = errno;
    ::close(lock_);
    if (reason != EWOULDBLOCK) {
      throw FileError(fmt::format("the output folder cannot be locked: {}", std::strerror(reason)),
                      {.file = path_.string()});
    }
    throw SceneError("another run is writing to this folder; wait for it, or give another folder with --out",
                     {.file = path_.string()});
  }
}

OutputFolder::~OutputFolder() {
  ::close(lock_);  // and with it goes the lock
}

bool OutputFolder::has_files() const {
  for (const char* name : run_files) {
    if (fs::exists(path_ / name)) return true;
  }
  return false;
}

void OutputFolder::discard() const {
  for (const char* name : run_files) {
    std::error_code error;
    fs::remove(path_ / name, error);
    if (error)
      throw FileError(fmt::format("cannot be removed: {}", error.message()), {.file = (path_ / name).string()});
  }
}

void OutputFolder::move_away() {
  std::error_code error;
  fs::path base = fs::weakly_canonical(path_, error);
  if (error) base = path_;
  if (base.filename().empty()) base = base.parent_path();
  fs::path target;
  for (int k = 1; target.empty() || fs::exists(target); ++k) target = base.string() + fmt::format(".{}", k);
  fs::create_directory(target, error);
  if (error)
    throw FileError(fmt::format("a finished run cannot be moved here: {}", error.message()), {.file = target.string()});
  for (const char* name : run_files) io::rename_if_there(path_ / name, target / name);
  io::sync_folder(target);
  moved_to_ = path_.is_absolute() ? target : fs::proximate(target, error);
}

std::optional<io::Checkpoint> OutputFolder::prepare(Existing existing) {
  if (!has_files()) return {};
  io::FoundCheckpoint found = find_checkpoint(path_);
  const bool finished = found.checkpoint && !found.checkpoint->outcome.empty();
  if (existing == Existing::resume) {
    if (found.checkpoint) return std::move(found.checkpoint);
    if (!found.damaged.empty()) {
      throw FileError(fmt::format("no valid checkpoint to resume from ({}); start over with --fresh",
                                  fmt::join(found.damaged, "; ")),
                      {.file = path_.string()});
    }
    discard();
  } else if (finished) {
    move_away();
  } else if (existing == Existing::fresh) {
    discard();
  } else {
    const std::string where = found.checkpoint ? fmt::format(" at step {}", found.checkpoint->step) : "";
    throw SceneError(
        fmt::format("there is an unfinished run here{}; continue it with --resume, or start over with --fresh", where),
        {.file = path_.string()});
  }
  return {};
}

}  // namespace noether

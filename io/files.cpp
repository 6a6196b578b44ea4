#include "io/files.hpp"

#include "io/near_file.hpp"
#include "numbers/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace noether::io {

namespace {

[[noreturn]] void fail(const std::filesystem::path& file, std::string_view what, int error) {
  throw FileError(fmt::format("{}: {}", what, std::generic_category().message(error)), {.file = file.string()});
}

[[noreturn]] void cannot_be_read(const std::filesystem::path& file, int error) {
  const bool named_wrongly = error == ENOENT || error == EISDIR;
  throw FileError(fmt::format("cannot be read: {}{}", std::generic_category().message(error),
                              named_wrongly ? near_file(file, "scene.toml") : ""),
                  {.file = file.string()});
}

/// A file descriptor that closes itself.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& file, int flags) : id_(::open(file.c_str(), flags | O_CLOEXEC, 0666)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (id_ >= 0) ::close(id_);
  }
  operator int() const { return id_; }  // NOLINT: stands wherever the system wants one

 private:
  int id_;
};

}  // namespace

std::string read_bytes(const std::filesystem::path& file, std::size_t most) {
  std::error_code unknown;
  if (std::filesystem::is_character_file(file, unknown)) {
    throw FileError("is a device, not a file", {.file = file.string()});
  }
  const Descriptor source(file, O_RDONLY);
  if (source < 0) cannot_be_read(file, errno);
  std::string bytes;
  const auto size = std::filesystem::file_size(file, unknown);
  std::size_t filled = 0;
  bytes.resize(std::min<std::size_t>(unknown ? 65536 : size + 1, most));
  while (filled < most) {
    const ssize_t got = ::read(source, bytes.data() + filled, bytes.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) cannot_be_read(file, errno);
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
    if (filled == bytes.size()) bytes.resize(std::min(2 * filled, most));
  }
  bytes.resize(filled);
  return bytes;
}

void write_and_sync(const std::filesystem::path& file, std::string_view bytes) {
  const auto give_up = [&](int error) {
    ::unlink(file.c_str());
    fail(file, "cannot be written", error);
  };
  const Descriptor target(file, O_WRONLY | O_CREAT | O_TRUNC);
  if (target < 0) fail(file, "cannot be written", errno);
  while (!bytes.empty()) {
    const ssize_t put = ::write(target, bytes.data(), bytes.size());
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) give_up(errno);
    bytes.remove_prefix(static_cast<std::size_t>(put));
  }
  if (::fsync(target) != 0) give_up(errno);
}

void write_text_file(const std::filesystem::path& file, const std::function<void(std::ofstream&)>& write) {
  std::ofstream target(file, std::ios::binary);
  const auto written = [&] {
    if (!target)
      throw FileError("cannot be written; check that the folder exists and the disk is not full",
                      {.file = file.string()});
  };
  written();
  write(target);
  target.close();
  written();
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) fail(folder, "cannot be made", error.value());
}

void sync_file(const std::filesystem::path& file) {
  const Descriptor opened(file, O_RDWR);
  if (opened < 0 || ::fsync(opened) != 0) fail(file, "cannot be written", errno);
}

void rename_if_there(const std::filesystem::path& from, const std::filesystem::path& to) {
  if (::rename(from.c_str(), to.c_str()) != 0 && errno != ENOENT) fail(to, "cannot be written", errno);
}

void sync_folder(const std::filesystem::path& folder) {
  const std::filesystem::path name = folder.empty() ? "." : folder;
  const Descriptor opened(name, O_RDONLY | O_DIRECTORY);
  if (opened < 0) fail(name, "cannot be flushed to disk", errno);
  // Some file systems cannot flush a folder; they say so by EINVAL.
  if (::fsync(opened) != 0 && errno != EINVAL) fail(name, "cannot be flushed to disk", errno);
}

}  // namespace noether::io

#include "io/sandbox.hpp"

#include "io/hdf5_file.hpp"
#include "numbers/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace noether::io {

namespace {

/// Whether this process is the child of a trial.
bool trying = false;

std::uintmax_t size_of(const std::filesystem::path& file) {
  std::error_code unknown;
  const auto size = std::filesystem::file_size(file, unknown);
  return unknown ? 0 : size;
}

/// Seconds of computing that reading and changing a file may take; a hundred times what it does take.
rlim_t enough_seconds(std::uintmax_t size) { return 10 + (size >> 20U); }

/// Bytes of memory, with those in use; several times what it does take. 0 if unknown.
rlim_t enough_memory(std::uintmax_t size) {
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const auto used = pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
  return used == 0 ? 0 : used + (rlim_t{1} << 30U) + 8 * size;
}

/// Lowers a limit of this process.
void limit(decltype(RLIMIT_CPU) what, rlim_t most) {
  rlimit now{};
  if (::getrlimit(what, &now) != 0 || now.rlim_cur <= most) return;
  now.rlim_cur = most;
  ::setrlimit(what, &now);
}

/// A crash is expected here: no core file, no words on stderr, no handler of the program around.
void prepare_to_crash(std::uintmax_t size) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU}) std::signal(signal, SIG_DFL);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, enough_seconds(size));
  if (const rlim_t memory = enough_memory(size); memory > 0) limit(RLIMIT_AS, memory);
  if (const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
}

bool is_open_as(int descriptor, const struct stat& file) {
  struct stat status = {};
  return ::fstat(descriptor, &status) == 0 && status.st_dev == file.st_dev && status.st_ino == file.st_ino;
}

/// Closes what the child has from its parent, but for three, the pipe, and the file itself, which HDF5 reads through
/// the descriptor that it has already: the lock of the output folder lives as long as somebody has it open, and a child
/// may live on where its parent is killed.
void keep_only(int pipe, const std::filesystem::path& file) {
  struct stat wanted = {};
  const bool known = ::stat(file.c_str(), &wanted) == 0;
  std::vector<int> kept = {pipe};
  std::error_code unknown;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", unknown)) {
    const int descriptor = std::atoi(entry.path().filename().c_str());
    if (descriptor > STDERR_FILENO && known && is_open_as(descriptor, wanted)) kept.push_back(descriptor);
  }
  std::sort(kept.begin(), kept.end());
  auto next = static_cast<unsigned>(STDERR_FILENO) + 1;
  for (const int descriptor : kept) {
    const auto stays = static_cast<unsigned>(descriptor);
    if (stays > next) ::close_range(next, stays - 1, 0);
    next = stays + 1;
  }
  ::close_range(next, ~0U, 0);
}

/// The child's report: a first byte says that it came back, what follows is the message of an error.
void tell(int pipe, std::string_view message) {
  std::string report = "+";
  report += message.substr(0, 4000);  // a pipe takes as much at once
  if (::write(pipe, report.data(), report.size()) < 0) ::_exit(1);
}

[[noreturn]] void be_child(int pipe, const std::filesystem::path& file, std::uintmax_t size,
                           const std::function<void()>& work) {
  trying = true;
  keep_only(pipe, file);
  prepare_to_crash(size);
  try {
    work();
    end_hdf5();  // what it has written over shows now, and not in the parent
    tell(pipe, "");
  } catch (const Error& error) {
    tell(pipe, error.message());
  } catch (const std::bad_alloc&) {
    tell(pipe, "damaged: reading it takes more memory than a file of its size can need");
  } catch (const std::exception&) {
    tell(pipe, "");
  }
  ::_exit(0);
}

std::string read_all(int pipe) {
  std::string all;
  std::array<char, 4096> buffer{};
  while (true) {
    const ssize_t got = ::read(pipe, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return all;
    all.append(buffer.data(), static_cast<std::size_t>(got));
  }
}

/// How a child ended that did not come back, in words.
std::string cause_of_death(pid_t child) {
  int status = 0;
  pid_t ended = -1;
  do ended = ::waitpid(child, &status, 0);
  while (ended < 0 && errno == EINTR);
  if (ended != child || !WIFSIGNALED(status)) return "crashes HDF5";
  if (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL) return "does not end";
  return fmt::format("crashes HDF5 (signal {})", WTERMSIG(status));
}

}  // namespace

void try_in_child(const std::filesystem::path& file, const std::function<void()>& work) {
  std::array<int, 2> ends{-1, -1};
  if (trying || ::pipe2(ends.data(), O_CLOEXEC) != 0) return;
  const std::uintmax_t size = size_of(file);
  const pid_t child = ::fork();
  if (child == 0) be_child(ends[1], file, size, work);
  ::close(ends[1]);
  const std::string report = child < 0 ? "+" : read_all(ends[0]);
  ::close(ends[0]);
  const std::string death = child < 0 ? "" : cause_of_death(child);
  if (report.empty()) throw FileError(fmt::format("damaged: reading it {}", death), {.file = file.string()});
  if (report.size() > 1) throw FileError(report.substr(1), {.file = file.string()});
}

}  // namespace noether::io

#pragma once
/// Other programs, run from a test: their output, their exit codes, signals to them.

#include "tests/support/files.hpp"

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace noether::test {

struct ProcessResult {
  int exit_code = -1;  ///< 128 + signal for a process that a signal has killed
  std::string out, err;
};

/// A running program; its output goes to files in `folder`, which is also its working directory.
class Process {
 public:
  Process(const std::vector<std::string>& arguments, const std::filesystem::path& folder);
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process();

  void signal(int number) const;
  ProcessResult wait();

 private:
  [[noreturn]] void become(char* const* words, const std::filesystem::path& folder) const;

  pid_t id_ = 0;
  std::filesystem::path out_, err_;
};

ProcessResult run_process(const std::vector<std::string>& arguments, const std::filesystem::path& folder);

/// The output of a script of tests/io, which must succeed; none, and a warning, where Python or a module of it is not
/// installed.
std::optional<std::string> python_output(const std::string& script, const std::vector<std::string>& arguments);

/// Checks that two HDF5 files agree value for value, in every group, dataset and attribute, where Python can tell.
void check_same_content(const std::filesystem::path& one, const std::filesystem::path& other);

/// Waits until `ready()` holds, at most 60 s. @return whether it does
template <class Ready> bool wait_until(const Ready& ready) {
  for (int k = 0; k < 6000; ++k) {
    if (ready()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

}  // namespace noether::test

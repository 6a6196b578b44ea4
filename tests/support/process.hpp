#pragma once
/// Other programs, run from a test: their output, their exit codes, signals to them.

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace noether::test {

/// A new folder for one test, removed with everything in it.
class ScratchFolder {
 public:
  ScratchFolder() {
    static std::atomic<int> count{0};
    const auto base = std::filesystem::temp_directory_path();
    path_ = base / ("noether-test-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string read_text(const std::filesystem::path& file) {
  std::ifstream source(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(source), {}};
}

inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

struct ProcessResult {
  int exit_code = -1;  ///< 128 + signal for a process that a signal has killed
  std::string out, err;
};

/// A running program; its output goes to files in `folder`, which is also its working directory.
class Process {
 public:
  Process(const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
    static std::atomic<int> count{0};
    const std::string tag = std::to_string(count++);
    out_ = folder / (".stdout-" + tag);
    err_ = folder / (".stderr-" + tag);
    std::vector<char*> words;
    for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    id_ = ::fork();
    if (id_ < 0) throw std::runtime_error("fork failed");
    if (id_ == 0) become(words.data(), folder);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    if (id_ <= 0) return;
    ::kill(id_, SIGKILL);
    ::waitpid(id_, nullptr, 0);
  }

  void signal(int number) const { ::kill(id_, number); }

  ProcessResult wait() {
    int status = 0;
    ::waitpid(id_, &status, 0);
    id_ = 0;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_text(out_), read_text(err_)};
  }

 private:
  [[noreturn]] void become(char* const* words, const std::filesystem::path& folder) const {
    const int out = ::open(out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int err = ::open(err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int in = ::open("/dev/null", O_RDONLY);
    if (out < 0 || err < 0 || in < 0 || ::chdir(folder.c_str()) != 0) ::_exit(125);
    ::dup2(in, 0);
    ::dup2(out, 1);
    ::dup2(err, 2);
    ::execvp(words[0], words);
    ::_exit(127);
  }

  pid_t id_ = 0;
  std::filesystem::path out_, err_;
};

inline ProcessResult run_process(const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
  return Process(arguments, folder).wait();
}

/// Waits until `ready()` holds, at most 60 s. @return whether it does
template <class Ready> bool wait_until(const Ready& ready) {
  for (int k = 0; k < 6000; ++k) {
    if (ready()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

/// The number behind `"key":` in one line of JSON; what follows up to the next comma or bracket.
inline std::string json_member(const std::string& json, const std::string& key) {
  const std::size_t at = json.find("\"" + key + "\":");
  if (at == std::string::npos) return "";
  const std::size_t begin = at + key.size() + 3;
  if (json[begin] == '"') return json.substr(begin, json.find('"', begin + 1) + 1 - begin);
  return json.substr(begin, json.find_first_of(",}]", begin) - begin);
}

/// The object or list behind `"key":`, with its brackets.
inline std::string json_block(const std::string& json, const std::string& key) {
  const std::size_t at = json.find("\"" + key + "\":");
  if (at == std::string::npos) return "";
  const std::size_t begin = at + key.size() + 3;
  int depth = 0;
  for (std::size_t end = begin; end < json.size(); ++end) {
    if (json[end] == '{' || json[end] == '[') ++depth;
    if ((json[end] == '}' || json[end] == ']') && --depth == 0) return json.substr(begin, end + 1 - begin);
  }
  return "";
}

}  // namespace noether::test

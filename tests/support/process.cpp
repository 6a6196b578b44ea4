#include "tests/support/process.hpp"

#include "tests/support/catch.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <stdexcept>

namespace noether::test {

Process::Process(const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
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

Process::~Process() {
  if (id_ <= 0) return;
  ::kill(id_, SIGKILL);
  ::waitpid(id_, nullptr, 0);
}

void Process::signal(int number) const { ::kill(id_, number); }

ProcessResult Process::wait() {
  int status = 0;
  ::waitpid(id_, &status, 0);
  id_ = 0;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_text(out_), read_text(err_)};
}

void Process::become(char* const* words, const std::filesystem::path& folder) const {
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

ProcessResult run_process(const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
  return Process(arguments, folder).wait();
}

std::optional<std::string> python_output(const std::string& script, const std::vector<std::string>& arguments) {
  const std::string python = NOETHER_PYTHON;
  std::vector<std::string> all{python, "-B", NOETHER_SOURCE_DIR "/tests/io/" + script};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const ScratchFolder folder;
  ProcessResult result{77, "there is no Python with h5py\n", ""};
  if (!python.empty()) result = run_process(all, folder.path());
  if (result.exit_code == 77) {
    WARN("skipped: " << result.out);
    return std::nullopt;
  }
  INFO(result.out << result.err);
  CHECK(result.exit_code == 0);
  return result.out;
}

void check_same_content(const std::filesystem::path& one, const std::filesystem::path& other) {
  python_output("compare_files.py", {one.string(), other.string()});
}

}  // namespace noether::test

#pragma once
/// Other programs, which live as long as a benchmark and answer when they are asked.

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <utility>

#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace noether::bench {

/// A script of bench/peers that drives another program. It greets with the version of that program, or ends at once
/// where there is none; from then on it answers every line it is sent with one line.
class PeerProgram {
 public:
  /// @param command  name of the script and its arguments, as a shell reads them
  explicit PeerProgram(const std::string& command) {
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return;
    const std::string line =
        fmt::format("OMP_NUM_THREADS=1 exec python3 '{}'/bench/peers/{}", NOETHER_SOURCE_DIR, command);
    child_ = fork();
    if (child_ == 0) {
      dup2(ends[1], STDIN_FILENO);
      dup2(ends[1], STDOUT_FILENO);
      execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
      _exit(127);
    }
    close(ends[1]);
    socket_ = ends[0];
    version_ = answer();
  }
  PeerProgram(PeerProgram&& other) noexcept
      : child_(std::exchange(other.child_, -1)),
        socket_(std::exchange(other.socket_, -1)),
        version_(std::move(other.version_)) {}
  PeerProgram(const PeerProgram&) = delete;
  PeerProgram& operator=(const PeerProgram&) = delete;
  PeerProgram& operator=(PeerProgram&&) = delete;
  ~PeerProgram() {
    if (socket_ >= 0) close(socket_);  // the script reads the end of its questions
    if (child_ > 0) waitpid(child_, nullptr, 0);
  }

  /// Of the other program; nothing where it is absent.
  const std::optional<std::string>& version() const { return version_; }

  /// The answer to a line; nothing from a script that has ended.
  std::optional<std::string> ask(const std::string& question) {
    const std::string line = question + "\n";
    for (std::size_t sent = 0; sent < line.size();) {
      const ssize_t more = send(socket_, line.data() + sent, line.size() - sent, MSG_NOSIGNAL);
      if (more <= 0) return {};
      sent += static_cast<std::size_t>(more);
    }
    return answer();
  }

 private:
  std::optional<std::string> answer() {
    std::string line;
    for (char next = 0; recv(socket_, &next, 1, 0) == 1;) {
      if (next == '\n') return line;
      line += next;
    }
    return {};
  }

  pid_t child_ = -1;
  int socket_ = -1;
  std::optional<std::string> version_;
};

}  // namespace noether::bench

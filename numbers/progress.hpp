#pragma once
/// How far a long task is, on one line of a terminal.

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace noether {

/// How far a task of several rows is.
struct Share {
  int row = 0;         ///< the one at work, counted from 1; 0: preparations
  int rows = 0;        ///< all of them; 0: not known yet
  double done = 0;     ///< of the whole work, from 0 to 1; of preparations, of the one at work
  std::string what{};  ///< what is being done: "verlet, step 0.01"
};

/// What is told while a task goes on.
using TellShare = std::function<void(const Share&)>;

/// A time as people say it: "12 s", "3 min", "2.5 h", "5 days".
/// @throws std::bad_alloc
std::string spoken_duration(double seconds);

/// A bar, such as "[######--------------]" for a share of 0.3; none of it is full where the share is not a number.
/// @throws std::bad_alloc
std::string progress_bar(double share, std::size_t width = 20);

/// The line of a share after so many seconds: "[######--------------]  30 %  run 4 of 12  verlet, step 0.01  7 s left".
/// @throws std::bad_alloc
std::string progress_text(const Share& share, double seconds);

/// One line on a terminal, written over again and again, never longer than the terminal is wide, and gone at the end.
/// Shows nothing where standard error is not a terminal.
class TerminalLine {
 public:
  explicit TerminalLine(bool wanted);
  ~TerminalLine();
  TerminalLine(const TerminalLine&) = delete;
  TerminalLine& operator=(const TerminalLine&) = delete;

  bool shows() const { return shows_; }
  /// Characters that have room: all columns but the last, where the text may wrap.
  std::size_t room() const;
  void show(std::string_view text);
  void clear();
  /// Shows shares, at most ten times a second; null where nothing shows. The line must live as long.
  TellShare teller();

 private:
  bool shows_, shown_ = false;
  std::chrono::steady_clock::time_point begin_, last_{};  ///< of the rows; of the last line
  bool counting_ = false;                                 ///< whether rows have begun
};

}  // namespace noether

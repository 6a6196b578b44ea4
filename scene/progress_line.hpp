#pragma once
/// The line that a terminal shows while a run goes on.

#include "engine/simulation.hpp"
#include "numbers/progress.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace noether {

/// What the line tells.
struct ProgressState {
  double share = 0;  ///< of the whole run, from 0 to 1
  double time = 0;   ///< by the clock [time]
  std::string_view time_unit = "1";
  double rate = 0;                     ///< [steps/s]
  std::optional<double> seconds_left;  ///< empty where nothing tells yet
  std::optional<double> energy_error;  ///< the worst so far; empty where the energy is not watched
};

/// One line: a bar, and as much of share, simulated time, time left, rate and worst relative error of the energy, in
/// this order, as has room.
/// @param columns  the line is never longer
std::string progress_text(const ProgressState& state, std::size_t columns);

/// The line on stderr, where that is a terminal; it is gone at the end.
class ProgressLine {
 public:
  explicit ProgressLine(bool wanted) : line_(wanted) {}

  /// @param begin  what the clock showed at step 0 [time]
  void attach(Simulation<double>& sim, double begin, std::string_view time_unit);

 private:
  TerminalLine line_;
};

}  // namespace noether

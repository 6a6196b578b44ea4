#pragma once
/// When a monitor looks.

#include <cstdint>
#include <string>

namespace noether {

/// At step 0 and every multiple of one of these; the others are 0.
struct Schedule {
  std::int64_t steps = 0;
  double interval = 0;  ///< of time, below 0 where time falls [time]
  double wall = 0;      ///< of wall time, at whole steps [s]; bits of the trajectory do not depend on it
};

namespace detail {

/// @throws Error  unless exactly one cadence is given, and it is possible
void check_schedule(const Schedule& schedule, const std::string& monitor);
/// @throws Error  below 1
std::int64_t positive_cadence(std::int64_t steps);
/// @throws Error  unless it is finite and above 0
double positive_cadence(double seconds);

// Monitors that look at every step should not wait for a division.
inline bool is_multiple(std::int64_t step, std::int64_t cadence) { return cadence == 1 || step % cadence == 0; }
inline std::int64_t next_multiple(std::int64_t step, std::int64_t cadence) {
  return cadence == 1 ? step + 1 : (step / cadence + 1) * cadence;
}

/// A schedule as the run reckons with it.
struct Looks : Schedule {
  std::int64_t in_a_row = 1;  ///< steps to look at, from each multiple on

  bool due(std::int64_t step) const { return steps > 0 && (steps == 1 || step % steps < in_a_row); }
  std::int64_t next(std::int64_t step) const {
    return in_a_row > 1 && step % steps + 1 < in_a_row ? step + 1 : next_multiple(step, steps);
  }
};

}  // namespace detail

}  // namespace noether

#include "engine/schedule.hpp"

#include "numbers/error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace noether::detail {

void check_schedule(const Schedule& schedule, const std::string& monitor) {
  const int given = (schedule.steps != 0) + (schedule.interval != 0) + (schedule.wall != 0);
  if (given != 1) {
    throw Error(fmt::format("monitor '{}' has {} cadences; give one: steps, an interval of time, or wall time", monitor,
                            given));
  }
  if (schedule.steps != 0) positive_cadence(schedule.steps);
  if (schedule.wall != 0) positive_cadence(schedule.wall);
}

std::int64_t positive_cadence(std::int64_t steps) {
  if (steps < 1) throw Error(fmt::format("a cadence of {} steps is impossible; at least 1 is expected", steps));
  return steps;
}

double positive_cadence(double seconds) {
  if (!(seconds > 0) || !std::isfinite(seconds)) {
    throw Error(fmt::format("a cadence of {} s is impossible; a finite time above 0 is expected", seconds));
  }
  return seconds;
}

}  // namespace noether::detail

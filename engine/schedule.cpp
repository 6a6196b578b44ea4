#include "engine/schedule.hpp"

#include "numbers/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace noether::detail {

void check_schedule(const Schedule& schedule, const std::string& monitor) {
  const int given = (schedule.steps != 0) + (schedule.interval != 0) + (schedule.wall != 0) + !schedule.times.empty();
  if (given != 1) {
    throw Error(
        fmt::format("monitor '{}' has {} cadences; give one: steps, an interval of time, wall time, or a list "
                    "of times",
                    monitor, given));
  }
  if (schedule.after && (schedule.wall != 0 || !schedule.times.empty())) {
    throw Error(
        fmt::format("monitor '{}' looks by {}, so it cannot begin after a time; after is for steps or an "
                    "interval of time",
                    monitor, schedule.wall != 0 ? "wall time" : "a list of times"));
  }
  if (schedule.after && !std::isfinite(*schedule.after)) {
    throw Error(
        fmt::format("monitor '{}' cannot begin after time {}; a finite time is expected", monitor, *schedule.after));
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

double checked_step(double dt) {
  if (!std::isfinite(dt) || dt == 0)
    throw Error(fmt::format("a step of {} is not valid; a finite time other than 0 is expected", dt));
  return dt;
}

void check_start(double start) {
  if (!std::isfinite(start)) {
    throw Error(fmt::format("a run cannot begin at time {}; a finite time is expected", start));
  }
}

std::int64_t steps_of(double duration, double dt) {
  const double exact = duration / dt;
  const double whole = std::round(exact);
  if (!std::isfinite(exact) || std::abs(exact) > 9e15) {
    throw Error(fmt::format("a duration of {} cannot be counted in steps of {}", duration, dt));
  }
  if (exact < 0)
    throw Error(
        fmt::format("a duration of {} lies in the past; steps of {} go in the opposite direction", duration, dt));
  // Beside 1e-9 of a step, the rounding of a long duration.
  if (std::abs(exact - whole) > 1e-9 + 16 * std::numeric_limits<double>::epsilon() * exact) {
    throw Error(fmt::format("a duration of {} is {} steps of {}; the nearest whole numbers are {} ({}) and {} ({})",
                            duration, exact, dt, std::floor(exact) * dt, std::floor(exact), std::ceil(exact) * dt,
                            std::ceil(exact)));
  }
  return static_cast<std::int64_t>(whole);
}

std::int64_t steps_to(double time, double start, double dt) {
  if (start == 0) return steps_of(time, dt);
  const double exact = (time - start) / dt, whole = std::round(exact);
  if (!(std::abs(exact) <= 9e15)) throw Error(fmt::format("time {} cannot be counted in steps of {}", time, dt));
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const double rounding = std::min(4 * epsilon * std::max(std::abs(time), std::abs(start)) / std::abs(dt), 0.01);
  if (exact < -rounding) throw Error(fmt::format("time {} lies before the start at {}", time, start));
  if (std::abs(exact - whole) > 1e-9 + 16 * epsilon * std::abs(exact) + rounding) {
    throw Error(
        fmt::format("time {} is {} steps of {} after the start at {}; the nearest whole numbers are at {} ({}) and {} "
                    "({})",
                    time, exact, dt, start, start + std::floor(exact) * dt, std::floor(exact),
                    start + std::ceil(exact) * dt, std::ceil(exact)));
  }
  return static_cast<std::int64_t>(std::abs(whole));
}

StepBefore step_before(double time, double start, double dt) {
  const double exact = (time - start) / dt, whole = std::round(exact);
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const double far = start == 0 ? 0 : 4 * epsilon * std::max(std::abs(time), std::abs(start)) / std::abs(dt);
  if (!(std::abs(exact) <= 9e15)) return {std::numeric_limits<std::int64_t>::max(), false};
  if (std::abs(exact - whole) <= 1e-9 + 16 * epsilon * std::abs(exact) + std::min(far, 0.01)) {
    return {static_cast<std::int64_t>(whole), true};
  }
  return {static_cast<std::int64_t>(std::floor(exact)), false};
}

void take_to_steps(Looks& looks, double start, double dt) {
  if (looks.interval != 0) {
    looks.steps = std::max<std::int64_t>(1, std::llround(looks.interval / dt));
    if (looks.after) {
      looks.from = std::exchange(looks.after, {});
      looks.first = first_multiple(*looks.from, start, dt, looks.steps);
    }
    return;
  }
  for (const double time : looks.times) {
    const std::int64_t step = std::llround((time - start) / dt);
    if (looks.at_steps.empty() || step > looks.at_steps.back()) looks.at_steps.push_back(step);
  }
}

std::int64_t first_multiple(double after, double start, double dt, std::int64_t cadence) {
  const double exact = (after - start) / dt;
  if (!(exact > 0)) return 0;
  constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();
  if (!(exact <= 9e15)) return never;
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const double far = start == 0 ? 0 : 4 * epsilon * std::max(std::abs(after), std::abs(start)) / std::abs(dt);
  const double rounding = 1e-9 + 16 * epsilon * exact + std::min(far, 0.01);
  const auto step = static_cast<std::int64_t>(std::max(std::ceil(exact - rounding), 0.0));
  const std::int64_t multiples = step / cadence + (step % cadence == 0 ? 0 : 1);
  return multiples > never / cadence ? never : multiples * cadence;
}

double at_start_if_rounded(double time, double start) {
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::abs(start);
  return std::abs(time - start) <= rounding ? start : time;
}

double rounding_of(double time, double start) {
  return 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(time), std::abs(start));
}

double look_by_interval(double start, std::int64_t k, double interval) {
  const double time = start + static_cast<double>(k) * interval, rounding = rounding_of(time, start);
  if (time == 0 || !(std::abs(interval) > 8 * rounding)) return time;  // looks stay apart
  // 15 digits are a whole number over a power of 10; as long as both are exact, so is the text's number.
  const int places = 14 - static_cast<int>(std::floor(std::log10(std::abs(time))));
  if (places < 0 || places > 22) return time;
  double power = 1;
  for (int digit = 0; digit < places; ++digit) power *= 10;
  const double written = std::round(time * power) / power;
  return std::abs(written - time) <= rounding ? written : time;
}

void check_times(const std::vector<double>& times, double start, double sign, const std::string& monitor) {
  for (std::size_t k = 0; k < times.size(); ++k) {
    const auto refuse = [&](const std::string& why) {
      throw Error(fmt::format("monitor '{}' cannot sample at time {}: {}", monitor, times[k], why));
    };
    if (!std::isfinite(times[k])) refuse("a finite time is expected");
    if (sign * (times[k] - start) < 0) refuse(fmt::format("it lies before the start at {}", start));
    if (k == 0) continue;
    if (times[k] == times[k - 1]) refuse("it is listed twice");
    if (sign * (times[k] - times[k - 1]) < 0)
      refuse(fmt::format("it is listed after {}, which the run reaches later", times[k - 1]));
  }
}

void check_equal_intervals(const std::vector<double>& times, const std::string& monitor) {
  for (std::size_t k = 2; k < times.size(); ++k) {
    const double first = times[1] - times[0], now = times[k] - times[k - 1];
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::abs(times[k]);
    if (std::abs(now - first) <= 1e-9 * std::abs(first) + rounding) continue;
    throw Error(
        fmt::format("monitor '{}' counts lags in samples, so it needs equal intervals: its list goes from {} to {}, "
                    "but its first two times are {} apart; attach it by steps or by an interval of time",
                    monitor, times[k - 1], times[k], first));
  }
}

std::vector<std::int64_t> steps_at(const std::vector<double>& times, double start, double dt,
                                   const std::string& monitor) {
  std::vector<std::int64_t> steps;
  for (const double time : times) {
    try {
      steps.push_back(steps_to(time, start, dt));
    } catch (const Error& error) {
      throw Error(fmt::format("monitor '{}' cannot sample at time {}: {}", monitor, time, error.message()));
    }
    if (steps.size() > 1 && steps.back() == steps[steps.size() - 2]) {
      throw Error(fmt::format("monitor '{}' cannot sample at time {}: it is listed twice, at step {}", monitor, time,
                              steps.back()));
    }
  }
  return steps;
}

std::string when_in_time(const Schedule& schedule) {
  if (!schedule.times.empty()) return "at times of a list";
  return schedule.interval == 0 ? "from a time on" : fmt::format("every {} of time", schedule.interval);
}

std::string_view how_without_time(const Schedule& schedule) {
  return schedule.interval == 0 && schedule.times.empty() ? "without after" : "by steps";
}

bool Looks::is_listed(std::int64_t step) const {
  const auto later = std::upper_bound(at_steps.begin(), at_steps.end(), step);
  return later != at_steps.begin() && step - *std::prev(later) < in_a_row;
}

std::int64_t Looks::next_listed(std::int64_t step) const {
  if (in_a_row > 1 && is_listed(step) && is_listed(step + 1)) return step + 1;
  const auto later = std::upper_bound(at_steps.begin(), at_steps.end(), step);
  return later == at_steps.end() ? std::numeric_limits<std::int64_t>::max() : *later;
}

}  // namespace noether::detail

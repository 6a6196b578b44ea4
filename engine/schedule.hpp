#pragma once
/// When a monitor looks.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// At step 0 and every multiple of one of the first three, or at the times of a list; the others are 0 or empty. Looks
/// by steps or by an interval may begin later.
struct Schedule {
  std::int64_t steps = 0;
  double interval = 0;               ///< of time, below 0 where time falls [time]
  double wall = 0;                   ///< of wall time, at whole steps [s]; bits of the trajectory do not depend on it
  std::vector<double> times = {};    ///< by the clock of the run, in the order in which it comes to them [time]
  std::optional<double> after = {};  ///< by the clock of the run: looks before are left out, the others stay [time]
};

namespace detail {

/// @throws Error  unless exactly one cadence is given, and it is possible
void check_schedule(const Schedule& schedule, const std::string& monitor);
/// @throws Error  below 1
std::int64_t positive_cadence(std::int64_t steps);
/// @throws Error  unless it is finite and above 0
double positive_cadence(double seconds);

/// @throws Error  if a step is 0 or not finite
double checked_step(double dt);
/// @throws Error  unless it is finite
void check_start(double start);
/// How many steps of `dt` make `duration` [time].
/// @throws Error  unless it is a whole number (to 1e-9), with the two nearest durations
std::int64_t steps_of(double duration, double dt);
/// How many lead from `start` to `time` [time]; both may be rounded.
/// @throws Error  unless it is a whole number, with the two nearest times
std::int64_t steps_to(double time, double start, double dt);
/// `start` for a time [time] that is it but for rounding, as after a change of units: 4 eps of it; others as they are.
double at_start_if_rounded(double time, double start);
/// How far from each other two times [time] of a run from `start` on may be and still be one but for rounding.
double rounding_of(double time, double start);
/// `start + k * interval` [time] as it would be written: the decimal of 15 digits where it is that but for rounding,
/// 0.3 and not 0.30000000000000004. It depends on nothing else, above all not on the end of the run.
double look_by_interval(double start, std::int64_t k, double interval);
/// @throws Error  unless times [time] are finite, none before `start`, each later than the one before as time runs
/// @param sign  1 where time rises, -1 where it falls
void check_times(const std::vector<double>& times, double start, double sign, const std::string& monitor);
/// @throws Error  unless the times of a list follow each other at one distance, to 1e-9
void check_equal_intervals(const std::vector<double>& times, const std::string& monitor);
/// The last whole step at or before a time [time], and whether it is at the time itself but for rounding, as
/// `steps_to` has it.
struct StepBefore {
  std::int64_t step = 0;
  bool whole = false;
};
StepBefore step_before(double time, double start, double dt);
/// The steps of a list of times; each is later than the one before. @throws Error  as `steps_to`, and for two at one
/// step
std::vector<std::int64_t> steps_at(const std::vector<double>& times, double start, double dt,
                                   const std::string& monitor);
/// The first multiple of a cadence of steps at or after the time `after` [time]; both may be rounded.
std::int64_t first_multiple(double after, double start, double dt, std::int64_t cadence);
/// When a monitor by time looks, in words.
std::string when_in_time(const Schedule& schedule);
/// How it could look instead.
std::string_view how_without_time(const Schedule& schedule);

// Monitors that look at every step should not wait for a division.
inline bool is_multiple(std::int64_t step, std::int64_t cadence) { return cadence == 1 || step % cadence == 0; }
inline std::int64_t next_multiple(std::int64_t step, std::int64_t cadence) {
  return cadence == 1 ? step + 1 : (step / cadence + 1) * cadence;
}

/// A schedule as the run reckons with it.
struct Looks : Schedule {
  std::int64_t in_a_row = 1;                ///< steps to look at, from each multiple or listed one on
  std::vector<std::int64_t> at_steps = {};  ///< those of `times`, where the clock is fixed; they rise
  std::optional<double> from = {};          ///< `after` of a fixed clock, which `first` has turned into steps [time]
  std::int64_t first = 0;                   ///< the multiple from which on to look, where the clock is fixed

  /// Whether steps tell when to look.
  bool by_steps() const { return steps > 0 || !at_steps.empty(); }
  /// Whether times tell: a fixed clock has turned them into steps.
  bool by_time() const { return (interval != 0 || !times.empty()) && !by_steps(); }
  bool due(std::int64_t step) const {
    if (steps > 0) return step >= first && (steps == 1 || step % steps < in_a_row);
    return !at_steps.empty() && is_listed(step);
  }
  /// The step after `step` that is looked at; none: the largest number there is.
  std::int64_t next(std::int64_t step) const {
    if (steps == 0) return next_listed(step);
    if (step < first) return first;
    return in_a_row > 1 && step % steps + 1 < in_a_row ? step + 1 : next_multiple(step, steps);
  }

 private:
  bool is_listed(std::int64_t step) const;
  std::int64_t next_listed(std::int64_t step) const;
};

/// Takes looks by time to the nearest whole steps, at least one from each other: where earlier versions had them with
/// steps of one length.
void take_to_steps(Looks& looks, double start, double dt);

}  // namespace detail

}  // namespace noether

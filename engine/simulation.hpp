#pragma once
/// A run: it owns state, integrator and monitors, and cuts time at the next moment somebody wants to see.

#include "engine/monitor.hpp"
#include "engine/schedule.hpp"
#include "engine/stop_condition.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <string>
#include <vector>

namespace noether {

/// Where a run stands, for a progress line.
struct Progress {
  std::int64_t step = 0, end = 0;
  double time = 0, seconds = 0;
  double until = std::numeric_limits<double>::infinity();  ///< the end, where the method chooses its steps [time]
};

/// Owns state, integrator and monitors.
///
/// The run is cut at the next monitor; all monitors of that step see one settled copy; the run goes on from the
/// unsettled original. Outputs cannot change a trajectory.
template <class Real = double> class Simulation {
 public:
  /// A run of fixed step `dt` [time] whose clock shows `start` [time] at step 0.
  /// @throws Error  if dt is 0 or not finite, the start is not finite, or the integrator chooses its steps or cannot
  ///                serve these particles
  template <Integrator I>
  Simulation(ParticleSystem<Real> particles, I integrator, double dt, double start = 0)
      : Simulation(std::move(particles), AnyIntegrator<Real>(std::move(integrator)),
                   Clock<Real>::fixed(start, detail::checked_step(dt))) {}

  /// A run of an integrator that chooses its own steps, from time 0 forward.
  template <Integrator I>
  Simulation(ParticleSystem<Real> particles, I integrator)
      : Simulation(std::move(particles), AnyIntegrator<Real>(std::move(integrator)), Clock<Real>::free(0)) {}

  /// A run from where `clock` stands, the way it goes: `Clock<double>::free(1000)`.
  /// @throws Error  if the integrator wants another clock, its start is not finite, or it cannot serve these particles
  Simulation(ParticleSystem<Real> particles, AnyIntegrator<Real> integrator, Clock<Real> clock);

  /// Attaches a monitor or writer that looks at step 0 and at every multiple of `steps`.
  /// @return the monitor, which stays where it is as long as the simulation lives
  template <class M> M& every(std::int64_t steps, M monitor) {
    return *add(AnyMonitor<Real>(std::move(monitor)), {.steps = detail::positive_cadence(steps)}).template get<M>();
  }
  /// The same by time [time], below 0 where time falls.
  template <class M> M& every_time(double interval, M monitor) {
    return *add(AnyMonitor<Real>(std::move(monitor)), {.interval = interval}).template get<M>();
  }
  /// Attaches a monitor or writer that looks at these times of the clock [time], in the order in which the run comes to
  /// them; those beyond its end are never seen. Bits of the trajectory do not depend on it.
  /// @throws Error  for no times, one that is not finite, before the start or out of order, and where steps are of one
  ///                length and a time is no whole number of them, unless the integrator claims `between_steps`
  template <class M> M& at_times(std::vector<double> times, M monitor) {
    return *attach(AnyMonitor<Real>(std::move(monitor)), {.times = std::move(times)}).template get<M>();
  }
  /// The same by wall time, at whole steps [s]. Bits of the trajectory do not depend on it.
  template <class M> M& every_wall(double seconds, M monitor) {
    return *add(AnyMonitor<Real>(std::move(monitor)), {.wall = detail::positive_cadence(seconds)}).template get<M>();
  }
  /// The same by a schedule, which may begin later: `sim.every({.steps = 10, .after = 100}, RadialDistribution())`
  /// leaves out what is before time 100. Errors that are relative to a start are then to the first look.
  /// @throws Error  unless exactly one cadence is given
  template <class M> M& every(const Schedule& schedule, M monitor) {
    return *attach(AnyMonitor<Real>(std::move(monitor)), schedule).template get<M>();
  }
  /// Attaches a monitor whose type is known only at run time: what a scene or another language asked for.
  /// @return the monitor, which stays where it is as long as the simulation lives
  /// @throws Error  unless exactly one cadence is given, and the run can serve the monitor
  AnyMonitor<Real>& attach(AnyMonitor<Real> monitor, const Schedule& schedule);
  /// Stops the run when `rule` holds, looked at every `steps`: `sim.stop_when(farther_than(100 * au), 4'000)`. Writers
  /// look where it stops.
  /// @throws Error  for a system without particles
  void stop_when(const StopRule& rule, std::int64_t steps);

  /// How many steps make `duration` [time].
  /// @throws Error  unless it is a whole number (to 1e-9), with the two nearest durations
  std::int64_t steps_in(double duration) const;

  /// Goes on for `steps` steps. The result tells how it ended; physics never throws, a writer that cannot write does.
  /// A step that fails (not finite, a solver without a solution) is undone: the state is the last whole step before it.
  Outcome run(std::int64_t steps);
  /// Goes on to time `until` [time]. Where the integrator chooses its steps, a time that has passed turns the run: it
  /// goes back from where `particles()` stand, as after an `edit`.
  /// @throws Error  if it has passed and steps are of one length, or monitors look by time; if steps of one length do
  ///                not end there
  Outcome run_until(double until);

  std::int64_t step() const { return raw_.clock().step(); }
  /// Time of `particles()` [time].
  double time() const {
    if (raw_.clock().mode() == ClockMode::fixed) return raw_.clock().time_at(step());
    return shown_at_.value_or(raw_.clock().high());
  }
  /// The settled, inertial particles at the present step; with a free clock, after `run_until`, at the time it was
  /// given, which a copy has reached: the run itself stands at the whole step before.
  const ParticleSystem<Real>& particles();
  IntegratorClaims claims() const { return integrator_.claims(); }
  Evaluations evaluations() const { return integrator_.evaluations(); }

  /// Changes particles: settles, calls `change(ParticleSystem<Real>&)` on inertial state, binds anew. An edit that
  /// throws, or whose result is refused, leaves the particles as they were.
  template <class Change> void edit(const Change& change) { edit_at(std::nullopt, change); }
  /// Changes the step [time], settling first; time and step count go on.
  /// @throws Error  if the integrator chooses its steps, or a monitor looks by time
  void change_step(double dt);

  /// Everything a restart needs. @cost O(n)
  SavedRun save() const;
  /// Goes back to a saved run of the same integrator and monitors.
  /// @throws Error  if the parts differ
  void restore(const SavedRun& saved);

  /// Calls `visit(name, AnyMonitor&)` for each monitor, in order of attachment; equal names are numbered.
  template <class Visit> void for_each_monitor(const Visit& visit) {
    for (auto& scheduled : monitors_) visit(scheduled.name, scheduled.monitor);
  }

  /// A flag that ends the run after the current step with outcome `interrupted`.
  void stop_on(const std::atomic<bool>* flag) { stop_flag_ = flag; }
  /// Called about ten times a second of wall time.
  void on_progress(std::function<void(const Progress&)> report) { progress_ = std::move(report); }
  /// Seconds spent stepping and observing in all calls of `run`.
  double seconds() const { return seconds_; }

 private:
  struct Scheduled {
    std::string name;
    detail::Looks schedule;
    AnyMonitor<Real> monitor;
    std::chrono::steady_clock::time_point last_wall;
    std::int64_t observed = 0;                 ///< by time: how many looks have been taken, or passed before it came
    bool records = false, looks_last = false;  ///< as the monitor says
    bool begun = false;                        ///< it has been shown where the run begins, if it wants to
    Request wanted = {};
  };
  struct ScheduledStop {
    std::int64_t steps;
    StopCheck<Real> check;
  };

  AnyMonitor<Real>& add(AnyMonitor<Real> monitor, const Schedule& schedule);
  /// @throws Error  unless there are particles, or the variables of a system, as the integrator wants them
  void check_state(const IntegratorClaims& claims) const;
  void register_last();
  void schedule(Scheduled& added);
  void schedule_by_time(Scheduled& added);
  void schedule_at_times(Scheduled& added);
  /// @throws Error  if this run has not what the monitor wants
  void check_wanted(const Scheduled& added) const;
  /// When a monitor by time takes its look `k`; one that a list does not have is never taken.
  double look_of(const Scheduled& s, std::int64_t k) const {
    const std::vector<double>& listed = s.schedule.times;
    if (listed.empty()) return detail::look_by_interval(raw_.clock().start(), k, s.schedule.interval);
    return k < std::ssize(listed) ? listed[static_cast<std::size_t>(k)] : raw_.clock().never();
  }
  double next_look(const Scheduled& s) const { return look_of(s, s.observed); }
  Snapshot<Real> snapshot(Request wanted, const std::optional<double>& at = std::nullopt) {
    const RunSource run{this, [](const void* self) { return static_cast<const Simulation*>(self)->save(); }};
    return Snapshot<Real>(integrator_, raw_, copy_, mapped_, wanted, at, action_, run);
  }
  /// Shows the state to those that a list of times makes wait for their first look.
  void show_start();
  std::optional<Outcome> observe_due();
  bool observe_times(double until);
  /// Takes the looks that are due at the end `limit` but for rounding, at their own times: those of a longer run.
  void observe_rounded(double limit);
  /// Takes the looks by time that are due from the last whole step of a fixed clock on, before the next one; at the
  /// last step of a run, `at_end`, those behind it are left to a longer run. @return a time that cannot be shown
  std::optional<double> observe_between(bool at_end);
  /// Where the next look of a monitor by time lies on a fixed clock.
  detail::StepBefore step_of_look(const Scheduled& s) const;
  /// Whether a monitor looks by time though steps are of one length.
  bool looks_between(const Scheduled& s) const {
    return s.schedule.by_time() && raw_.clock().mode() == ClockMode::fixed;
  }
  Outcome fail_before(double unreached);
  bool due(const Scheduled& scheduled) const;
  /// Whether a time is one at which a monitor that begins later looks.
  bool has_begun(const Scheduled& scheduled, double time) const {
    return !scheduled.schedule.after || !raw_.clock().is_later(*scheduled.schedule.after, time);
  }
  void show(const Snapshot<Real>& moment);
  std::int64_t next_cut(std::int64_t end) const;
  /// Whether a monitor looks here and at the next step, and wants to know the action between.
  bool action_is_wanted() const;
  Advance advance(const Span& span);
  double next_time(double end) const;
  /// What is wrong with a state, if it is not finite.
  std::optional<Outcome> fault(const ParticleSystem<Real>& s) const;
  std::optional<Outcome> settled_fault();
  Outcome outcome(Outcome::Kind kind, std::string message = "") const;
  Outcome stopped(const StopReason& reason) const;
  Outcome failed(const Failure& failure) const;
  std::optional<Outcome> keep_good();
  void keep();
  Outcome fall_back();
  std::optional<Outcome> look_at_the_end();
  void show_to_writers(const Outcome& ended);
  bool has_looked(const Scheduled& scheduled, double end, bool between_steps) const;
  std::int64_t unresolved() const;
  Outcome run_to(std::int64_t end, double limit);
  void turn_back(double until);
  /// @throws Error  unless a saved run has the columns that this one moves
  void check_columns(const ParticleSystem<Real>& saved) const;
  /// @param at  free clock: the time to settle at, beyond the last whole step
  template <class Change> void edit_at(std::optional<double> at, const Change& change) {
    begin_edit(at);
    const ParticleSystem<Real> before = raw_;
    try {
      change(raw_);
      end_edit();
    } catch (...) {
      raw_ = before;
      take_edited();
      throw;
    }
  }
  void begin_edit(std::optional<double> at);
  void end_edit();
  void take_edited();

  /// A whole step to fall back to.
  struct Good {
    ParticleSystem<Real> particles;
    SavedState integrator;
  };

  ParticleSystem<Real> raw_, copy_, mapped_;
  std::optional<Good> good_;  ///< while a run goes on: at most 1024 steps and a cut old
  AnyIntegrator<Real> integrator_;
  std::list<Scheduled> monitors_;  ///< one that is added moves no other
  std::vector<ScheduledStop> stops_;
  std::optional<double> shown_at_;      ///< free clock: where `run_until` has ended, beyond the last whole step
  std::int64_t observed_through_ = -1;  ///< last step whose due monitors have looked
  std::vector<Scheduled*> looking_;     ///< at the present moment
  std::int64_t unresolved_at_end_ = 0;  ///< pairs that may have met between the last look of a stop and the end
  Real action_ = Real(0);               ///< of the last step, where it was wanted
  std::int64_t chunk_ = 16;             ///< steps between looks at the wall clock
  std::chrono::steady_clock::time_point looked_at_clock_;
  const std::atomic<bool>* stop_flag_ = nullptr;
  std::function<void(const Progress&)> progress_;
  double seconds_ = 0;
};

template <class Real, class I> Simulation(ParticleSystem<Real>, I, double) -> Simulation<Real>;
template <class Real, class I> Simulation(ParticleSystem<Real>, I, double, double) -> Simulation<Real>;
template <class Real, class I> Simulation(ParticleSystem<Real>, I, Clock<Real>) -> Simulation<Real>;
template <class Real, class I> Simulation(ParticleSystem<Real>, I) -> Simulation<Real>;

extern template class Simulation<double>;
extern template class Simulation<Quad>;

}  // namespace noether

// Looks at times, which a run is cut at, whole steps or not.

#include "engine/simulation.hpp"

#include <fmt/format.h>

namespace noether {

/// Whether the run comes to that time: a method that chooses its steps may fail on the way from the last whole one.
template <class Real> bool Simulation<Real>::observe_times(double until) {
  looking_.clear();
  Request wanted;
  for (auto& scheduled : monitors_) {
    if (!scheduled.schedule.by_time() || raw_.clock().is_later(next_look(scheduled), until)) continue;
    ++scheduled.observed;
    looking_.push_back(&scheduled);
    wanted.energy = wanted.energy || scheduled.wanted.energy;
  }
  const Clock<Real>& clock = raw_.clock();
  const bool at_step = clock.mode() == ClockMode::fixed && detail::step_before(until, clock.start(), clock.dt()).whole;
  const Snapshot<Real> moment = snapshot(wanted, at_step ? std::nullopt : std::optional(until));
  if (fault(moment.state())) {
    for (Scheduled* one : looking_) --one->observed;
    return false;
  }
  if (!looking_.empty()) show(moment);
  return true;
}

template <class Real> void Simulation<Real>::observe_rounded(double limit) {
  const Clock<Real>& clock = raw_.clock();
  const double end = limit + clock.sign() * detail::rounding_of(limit, clock.start());
  for (double look = next_time(clock.never()); !clock.is_later(look, end); look = next_time(clock.never())) {
    if (!observe_times(look)) return;  // it fails behind the end; a longer run will tell
  }
}

template <class Real> detail::StepBefore Simulation<Real>::step_of_look(const Scheduled& s) const {
  return detail::step_before(next_look(s), raw_.clock().start(), raw_.clock().dt());
}

template <class Real> std::optional<double> Simulation<Real>::observe_between(bool at_end) {
  if (raw_.clock().mode() != ClockMode::fixed) return {};
  while (true) {
    const Scheduled* first = nullptr;
    for (const auto& scheduled : monitors_) {
      if (!scheduled.schedule.by_time()) continue;
      const detail::StepBefore look = step_of_look(scheduled);
      if (look.step > step() || (at_end && !look.whole)) continue;
      if (first == nullptr || raw_.clock().is_later(next_look(*first), next_look(scheduled))) first = &scheduled;
    }
    if (first == nullptr) return {};
    const double look = next_look(*first);
    if (!observe_times(look)) return look;
  }
}

/// Makes the steps that lead to a time which cannot be shown. Mostly the run fails on the way there; where it does not,
/// as where a shorter step that ends there cannot be made, it ends at the last whole step before that time.
template <class Real> Outcome Simulation<Real>::fail_before(double unreached) {
  keep();
  const Span one{.steps = 1, .limit = raw_.clock().never()};
  while (integrator_.advance(raw_, one).failure == nullptr && !fault(raw_)) {
    if (!raw_.clock().is_later(raw_.clock().at_step(), unreached)) continue;
    raw_.assign_state(good_->particles);
    integrator_.load(good_->integrator, "");
    return outcome(Outcome::Kind::solver_failure,
                   fmt::format("no step of '{}' that ends at time {:.9g} succeeds, where the state is to be shown, "
                               "though the run itself steps past it; choose other times",
                               integrator_.claims().method, unreached));
  }
  return fall_back();
}

template <class Real> double Simulation<Real>::next_time(double end) const {
  double next = end;
  if (raw_.clock().mode() == ClockMode::fixed) return next;
  for (const auto& scheduled : monitors_) {
    if (!scheduled.schedule.by_time()) continue;
    const double look = next_look(scheduled);
    if (raw_.clock().is_later(next, look)) next = look;
  }
  return next;
}

template bool Simulation<double>::observe_times(double until);
template void Simulation<double>::observe_rounded(double limit);
template detail::StepBefore Simulation<double>::step_of_look(const Scheduled& s) const;
template std::optional<double> Simulation<double>::observe_between(bool at_end);
template Outcome Simulation<double>::fail_before(double unreached);
template double Simulation<double>::next_time(double end) const;
template bool Simulation<Quad>::observe_times(double until);
template void Simulation<Quad>::observe_rounded(double limit);
template detail::StepBefore Simulation<Quad>::step_of_look(const Scheduled& s) const;
template std::optional<double> Simulation<Quad>::observe_between(bool at_end);
template Outcome Simulation<Quad>::fail_before(double unreached);
template double Simulation<Quad>::next_time(double end) const;

}  // namespace noether

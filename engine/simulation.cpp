#include "engine/simulation.hpp"

#include "engine/check_wanted.hpp"
#include "engine/not_finite.hpp"
#include "engine/second_words.hpp"
#include "numbers/cost_book.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace noether {

namespace {

using WallClock = std::chrono::steady_clock;

/// The state is looked at for finite values at least this often.
constexpr std::int64_t longest_chunk = 1024;
/// Steps between looks at the wall clock are chosen to last about this long [s].
constexpr double chunk_seconds = 0.05;
/// So long they may last where the integrator wants some steps at once [s].
constexpr double longest_wait = 1;

/// What a force has named says more than what came of it.
bool tells_more(const Failure* failure, const std::optional<Outcome>& fault) {
  using Kind = Outcome::Kind;
  return failure != nullptr && (!fault || failure->kind == Kind::overlap || failure->kind == Kind::overstretch ||
                                failure->kind == Kind::inverted_element);
}

double seconds_since(WallClock::time_point start) {
  return std::chrono::duration<double>(WallClock::now() - start).count();
}

}  // namespace

template <class Real>
Simulation<Real>::Simulation(ParticleSystem<Real> particles, AnyIntegrator<Real> integrator, Clock<Real> clock)
    : raw_(std::move(particles)), copy_(raw_.units()), mapped_(raw_.units()), integrator_(std::move(integrator)) {
  const IntegratorClaims claims = integrator_.claims();
  check_state(claims);
  if (claims.clock != clock.mode()) {
    throw Error(fmt::format("method '{}' {}", claims.method,
                            claims.clock == ClockMode::fixed
                                ? "takes steps of one length; give the step after the integrator"
                                : "chooses its steps itself; leave out the step after the integrator"));
  }
  if (clock.mode() == ClockMode::free && clock.direction() == Direction::backward && !claims.backward) {
    throw Error(fmt::format("method '{}' cannot go back in time; give it a clock that goes forward", claims.method));
  }
  detail::check_start(clock.start());
  if (clock.mode() == ClockMode::fixed) detail::checked_step(clock.dt());
  raw_.trim();
  raw_.clock() = clock;
  raw_.keep_low_words(false);  // those of another run belong to its working coordinates
  integrator_.bind(raw_);
}

template <class Real> void Simulation<Real>::check_state(const IntegratorClaims& claims) const {
  if (raw_.size() == 0 && raw_.variables().empty()) throw Error("there are no particles; a run needs at least one");
  if (raw_.size() > 0 && !raw_.variables().empty()) {
    throw Error("there are particles as well as variables; a run is of particles or of a first-order system");
  }
  if (claims.variables == raw_.variables().empty()) {
    throw Error(claims.variables
                    ? fmt::format("system '{}' has variables, but it was given particles", claims.hamiltonian)
                    : fmt::format("method '{}' moves particles, but it was given the variables of a system of first "
                                  "order; use a method for y' = f, such as 'dop853' or 'rodas_5p'",
                                  claims.method));
  }
}

template <class Real> AnyMonitor<Real>& Simulation<Real>::attach(AnyMonitor<Real> monitor, const Schedule& schedule) {
  detail::check_schedule(schedule, monitor.name());
  return add(std::move(monitor), schedule);
}

template <class Real> AnyMonitor<Real>& Simulation<Real>::add(AnyMonitor<Real> monitor, const Schedule& schedule) {
  monitors_.push_back({"", {schedule}, std::move(monitor), std::chrono::steady_clock::now()});
  register_last();
  return monitors_.back().monitor;
}

template <class Real> void Simulation<Real>::register_last() {
  try {
    schedule(monitors_.back());
  } catch (...) {
    monitors_.pop_back();
    throw;
  }
}

template <class Real> void Simulation<Real>::schedule(Scheduled& added) {
  const std::string base = added.monitor.name().empty() ? "monitor" : added.monitor.name();
  added.name = base;
  added.records = added.monitor.records();
  added.looks_last = added.monitor.looks_last();
  added.wanted = added.monitor.wanted();
  added.schedule.in_a_row = added.monitor.steps_in_a_row();
  for (int k = 2; std::any_of(monitors_.begin(), std::prev(monitors_.end()),
                              [&](const Scheduled& other) { return other.name == added.name; });
       ++k) {
    added.name = fmt::format("{}_{}", base, k);
  }
  if (added.schedule.steps == 0 && added.schedule.wall == 0) schedule_by_time(added);
  if (added.schedule.after && added.schedule.by_steps() && raw_.clock().mode() == ClockMode::fixed) {
    // Steps tell from here on.
    added.schedule.from = std::exchange(added.schedule.after, {});
    added.schedule.first =
        detail::first_multiple(*added.schedule.from, raw_.clock().start(), raw_.clock().dt(), added.schedule.steps);
  }
  check_wanted(added);
}

template <class Real> void Simulation<Real>::check_wanted(const Scheduled& added) const {
  const IntegratorClaims claims = integrator_.claims();
  const bool lacking = added.wanted.energy && !claims.energy;
  if (claims.variables && (added.monitor.needs_particles() || lacking)) {
    throw Error(fmt::format("monitor '{}' watches particles, but system '{}' has only variables", added.name,
                            claims.hamiltonian));
  }
  added.monitor.check(raw_);
  // A copy is asked: the run itself must not know.
  const bool virial = added.wanted.virial && AnyIntegrator<Real>(integrator_).virial(raw_);
  detail::check_wanted(added.name, added.wanted, claims,
                       {.virial = virial, .action = integrator_.has_action(), .by_steps = added.schedule.by_steps()});
}

template <class Real> void Simulation<Real>::schedule_by_time(Scheduled& added) {
  if (!added.schedule.times.empty()) return schedule_at_times(added);
  const double interval = added.schedule.interval;
  const bool forward = raw_.clock().direction() == Direction::forward;
  if (!std::isfinite(interval) || interval == 0 || (interval > 0) != forward) {
    throw Error(fmt::format("monitor '{}' cannot sample every {} of time; a finite time {} 0 is expected", added.name,
                            interval, forward ? "above" : "below"));
  }
  const double dt = raw_.clock().dt();
  const bool between = integrator_.claims().between_steps && !detail::step_before(interval, 0, dt).whole;
  if (raw_.clock().mode() == ClockMode::free || between) {
    // One that comes late has nothing to say of times that have passed.
    const Clock<Real>& clock = raw_.clock();
    const double from = has_begun(added, time()) ? time() : *added.schedule.after;
    const double passed = std::floor((from - clock.start()) / interval);
    if (passed > 0 && passed < 9e15) added.observed = static_cast<std::int64_t>(passed);
    const double rounding = clock.sign() * detail::rounding_of(from, clock.start());
    while (clock.is_later(from, next_look(added) + rounding)) ++added.observed;
    return;
  }
  const std::int64_t steps = steps_in(interval);
  if (steps == 0) {
    throw Error(fmt::format("monitor '{}' cannot sample every {} of time; a step is {}", added.name, interval, dt));
  }
  added.schedule.steps = steps;
}

template <class Real> void Simulation<Real>::stop_when(const StopRule& rule, std::int64_t steps) {
  const IntegratorClaims claims = integrator_.claims();
  if (claims.variables) {
    throw Error(fmt::format("stop '{}' watches distances of particles, but system '{}' has only variables",
                            rule.kind == StopRule::Kind::escape ? "escape" : "collision", claims.hamiltonian));
  }
  stops_.push_back({detail::positive_cadence(steps), StopCheck<Real>(rule)});
}

template <class Real> void Simulation<Real>::schedule_at_times(Scheduled& added) {
  const Clock<Real>& clock = raw_.clock();
  std::vector<double>& times = added.schedule.times;
  if (!times.empty()) times[0] = detail::at_start_if_rounded(times[0], clock.start());
  detail::check_times(times, clock.start(), clock.sign(), added.name);
  if (added.monitor.needs_equal_intervals()) detail::check_equal_intervals(times, added.name);
  const bool between = integrator_.claims().between_steps && std::any_of(times.begin(), times.end(), [&](double t) {
                         return !detail::step_before(t, clock.start(), clock.dt()).whole;
                       });
  if (clock.mode() == ClockMode::fixed && !between) {
    added.schedule.at_steps = detail::steps_at(times, clock.start(), clock.dt(), added.name);
    return;
  }
  // One that comes late has nothing to say of times that have passed.
  added.observed = std::count_if(times.begin(), times.end(), [&](double t) { return clock.is_later(time(), t); });
}

template <class Real> std::int64_t Simulation<Real>::steps_in(double duration) const {
  return detail::steps_of(duration, raw_.clock().dt());
}

template <class Real> Outcome Simulation<Real>::run(std::int64_t steps) {
  if (steps < 0) throw Error(fmt::format("{} steps cannot be made; a number of at least 0 is expected", steps));
  const std::int64_t most = std::numeric_limits<std::int64_t>::max() - std::max(step(), std::int64_t{0});
  return run_to(step() + std::min(steps, most), raw_.clock().never());
}

template <class Real> Outcome Simulation<Real>::run_until(double until) {
  if (std::isnan(until)) throw Error("time nan is not a valid end of a run; a finite time is expected");
  const Clock<Real>& clock = raw_.clock();
  const bool free = clock.mode() == ClockMode::free;
  // Half a step of grace: a time that has been reached may be rounded differently.
  const bool passed = clock.is_later(time() - clock.dt() / 2, until);
  if (free && passed) turn_back(until);
  if (free) return run_to(std::numeric_limits<std::int64_t>::max(), until);
  if (passed) throw Error(fmt::format("time {} has passed: the run is already at {}", until, time()));
  return run_to(detail::steps_to(until, clock.start(), clock.dt()), clock.never());
}

template <class Real> void Simulation<Real>::turn_back(double until) {
  const auto refuse = [&](const std::string& why) {
    throw Error(fmt::format("time {} has passed: the run is already at {}, and {}", until, time(), why));
  };
  const IntegratorClaims claims = integrator_.claims();
  if (!claims.backward) refuse(fmt::format("method '{}' cannot go back in time", claims.method));
  for (const auto& scheduled : monitors_) {
    if (!scheduled.schedule.by_time() && !scheduled.schedule.after) continue;
    refuse(fmt::format("monitor '{}' samples {}, so the run cannot turn back; attach it {}", scheduled.name,
                       detail::when_in_time(scheduled.schedule), detail::how_without_time(scheduled.schedule)));
  }
  edit_at(shown_at_, [](ParticleSystem<Real>& particles) { particles.clock().turn(); });
}

template <class Real> Outcome Simulation<Real>::run_to(std::int64_t end, double limit) {
  shown_at_.reset();
  std::optional<Outcome> result = fault(raw_);
  if (!result) result = keep_good();
  if (!result) show_start();
  if (!result) result = observe_due();  // before the clock starts: writers open their files when they first look
  if (result) {
    show_to_writers(*result);
    return *result;
  }
  if (CostBook* const book = CostBook::of_this_thread()) book->begin_anew();
  const auto started = WallClock::now();
  const double before = seconds_;
  looked_at_clock_ = started;
  auto reported = started;
  const std::int64_t at_once = integrator_.claims().steps_at_once;
  chunk_ = std::max(chunk_, at_once);
  std::int64_t unclocked = 0;  // steps since the last look at the wall clock, which costs as much as a short step
  while (true) {
    if ((result = observe_due())) break;
    if (const auto unreached = observe_between(step() >= end)) {
      result = fault(raw_) ? fall_back() : fail_before(*unreached);
      break;
    }
    if (step() >= end) break;
    if (step() - good_->particles.clock().step() >= longest_chunk && (result = keep_good())) break;
    if (stop_flag_ != nullptr && stop_flag_->load(std::memory_order_relaxed)) {
      result = outcome(Outcome::Kind::interrupted);
      break;
    }
    const std::int64_t steps = next_cut(end) - step();
    const Advance done = advance({steps, next_time(limit), stop_flag_});
    unclocked += done.steps;
    const bool chunk_is_full = unclocked >= chunk_ || done.at_limit || step() >= end;
    if (chunk_is_full) {
      const auto now = WallClock::now();
      const double took = std::chrono::duration<double>(now - looked_at_clock_).count();
      if (took < chunk_seconds / 2) chunk_ = std::min(longest_chunk, chunk_ * 2);
      if (took > (chunk_ > at_once ? chunk_seconds : longest_wait) && chunk_ > 1) chunk_ /= 2;
      looked_at_clock_ = now;
      seconds_ = before + std::chrono::duration<double>(now - started).count();
      unclocked = 0;
    }
    if (done.failure != nullptr || (chunk_is_full && fault(raw_))) {
      result = fall_back();
      break;
    }
    if (done.at_limit) {
      const double reached = next_time(limit);
      if (!observe_times(reached)) {
        result = fail_before(reached);
        break;
      }
      if (!raw_.clock().is_later(limit, reached)) {
        observe_rounded(limit);
        shown_at_ = limit;
        break;
      }
    }
    if (progress_ && looked_at_clock_ - reported > std::chrono::milliseconds(100)) {
      reported = looked_at_clock_;
      progress_({step(), end, time(), before + seconds_since(started), limit});
    }
  }
  if (!result && settled_fault()) result = fall_back();
  unresolved_at_end_ = 0;
  if (!result) result = look_at_the_end();
  if (result) show_to_writers(*result);
  seconds_ = before + seconds_since(started);
  good_.reset();
  Outcome ended = result ? *result : outcome(Outcome::Kind::completed);
  ended.unresolved = unresolved();
  return ended;
}

template <class Real> Advance Simulation<Real>::advance(const Span& span) {
  if (span.steps > 1 || !action_is_wanted()) return integrator_.advance(raw_, span);
  action_ = Real(0);
  return integrator_.advance_with_action(raw_, span, action_);
}

template <class Real> bool Simulation<Real>::action_is_wanted() const {
  return std::any_of(monitors_.begin(), monitors_.end(), [&](const Scheduled& s) {
    return s.wanted.action && s.schedule.due(step()) && s.schedule.due(step() + 1);
  });
}

template <class Real> std::optional<Outcome> Simulation<Real>::keep_good() {
  if (const auto bad = settled_fault()) return good_ ? fall_back() : *bad;
  keep();
  return {};
}

template <class Real> void Simulation<Real>::keep() {
  if (!good_) good_.emplace(Good{ParticleSystem<Real>(raw_.units()), {}});
  good_->particles.assign_state(raw_);
  good_->integrator.clear();
  integrator_.save(good_->integrator, "");
}

/// Goes again, step by step, from the last state kept to the step that failed: where a run ends must not depend on when
/// somebody looked. The state is the last whole step before, the outcome tells what came after it.
template <class Real> Outcome Simulation<Real>::fall_back() {
  const std::int64_t failing = step();
  const auto go_back = [&] {
    raw_.assign_state(good_->particles);
    integrator_.load(good_->integrator, "");
  };
  go_back();
  while (true) {
    const Span one{.steps = 1, .limit = raw_.clock().never()};
    const Failure* failure = integrator_.advance(raw_, one).failure;
    std::optional<Outcome> reason = fault(raw_);
    if (tells_more(failure, reason)) reason = failed(*failure);
    if (!reason && (reason = settled_fault())) {
      failure = integrator_.advance(raw_, one).failure;  // begins with what was to complete this one
      if (tells_more(failure, reason)) reason = failed(*failure);
    }
    if (reason) {
      go_back();
      reason->step = step();
      reason->time = time();
      return *reason;
    }
    if (step() > failing) throw LogicError("a step that failed succeeded when it was repeated");
    keep();
  }
}

/// Stops that were not due at the last step look at it too, and forget what they saw: a run that goes on later is the
/// run that was never cut.
template <class Real> std::optional<Outcome> Simulation<Real>::look_at_the_end() {
  const bool between_steps = shown_at_ && raw_.clock().is_later(*shown_at_, raw_.clock().at_step());
  const Snapshot<Real> moment = snapshot({}, between_steps ? shown_at_ : std::nullopt);
  for (const ScheduledStop& stop : stops_) {
    if (!between_steps && detail::is_multiple(step(), stop.steps)) continue;
    StopCheck<Real> check = stop.check;
    if (const auto reason = check.look(moment)) return stopped(*reason);  // there, between steps or not
    unresolved_at_end_ += check.unresolved() - stop.check.unresolved();
  }
  for (Scheduled& scheduled : monitors_) {
    if (!scheduled.monitor.looks_at_the_end()) continue;
    if (step() < scheduled.schedule.first || !has_begun(scheduled, moment.time())) continue;
    if (!has_looked(scheduled, moment.time(), between_steps)) scheduled.monitor.at_end(moment);
  }
  return {};
}

/// Whoever writes files looks where a run has stopped or failed, due or not: nobody goes on from there, and the state
/// that is told of must be one that can be read. A run that is interrupted goes on.
template <class Real> void Simulation<Real>::show_to_writers(const Outcome& ended) {
  if (ended.kind == Outcome::Kind::completed || ended.kind == Outcome::Kind::interrupted) return;
  const bool between_steps = shown_at_ && raw_.clock().is_later(*shown_at_, raw_.clock().at_step());
  const Snapshot<Real> moment = snapshot({}, between_steps ? shown_at_ : std::nullopt);
  if (fault(moment.state())) return;
  for (Scheduled& scheduled : monitors_) {
    if (scheduled.records && !has_looked(scheduled, moment.time(), between_steps)) scheduled.monitor.observe(moment);
  }
}

/// Whether a monitor has seen the end of the run already. Looks within a step that then fails are of later times.
template <class Real>
bool Simulation<Real>::has_looked(const Scheduled& scheduled, double end, bool between_steps) const {
  if (scheduled.schedule.by_steps()) return !between_steps && due(scheduled);
  if (!scheduled.schedule.by_time() || scheduled.observed == 0 || !has_begun(scheduled, end)) return false;
  const Clock<Real>& clock = raw_.clock();
  const double last = look_of(scheduled, scheduled.observed - 1);
  if (clock.mode() == ClockMode::fixed && !between_steps) {
    const detail::StepBefore look = detail::step_before(last, clock.start(), clock.dt());
    return look.whole && look.step == step();
  }
  return std::abs(last - end) <= detail::rounding_of(end, clock.start());
}

template <class Real> std::int64_t Simulation<Real>::unresolved() const {
  std::int64_t all = unresolved_at_end_;
  for (const ScheduledStop& stop : stops_) all += stop.check.unresolved();
  return all;
}

template <class Real> bool Simulation<Real>::due(const Scheduled& scheduled) const {
  if (scheduled.schedule.by_steps()) return scheduled.schedule.due(step()) && has_begun(scheduled, raw_.clock().high());
  if (scheduled.schedule.wall <= 0) return false;
  return std::chrono::duration<double>(looked_at_clock_ - scheduled.last_wall).count() >= scheduled.schedule.wall;
}

template <class Real> void Simulation<Real>::show_start() {
  for (auto& scheduled : monitors_) {
    const bool later = scheduled.schedule.first > 0 || scheduled.schedule.after;
    const bool waits = !scheduled.schedule.times.empty() || (later && scheduled.records);
    if (std::exchange(scheduled.begun, true) || !waits) continue;
    scheduled.monitor.at_start(snapshot({.energy = scheduled.wanted.energy}));
  }
}

template <class Real> std::optional<Outcome> Simulation<Real>::observe_due() {
  if (observed_through_ == step()) return std::nullopt;
  observed_through_ = step();
  looking_.clear();
  Request wanted;
  for (auto& scheduled : monitors_) {
    if (!due(scheduled)) continue;
    looking_.push_back(&scheduled);
    scheduled.last_wall = looked_at_clock_;
    wanted.energy = wanted.energy || scheduled.wanted.energy;
    wanted.virial = wanted.virial || scheduled.wanted.virial;
    wanted.action = wanted.action || scheduled.wanted.action;
  }
  const auto stop_due = [&](const ScheduledStop& stop) { return detail::is_multiple(step(), stop.steps); };
  if (looking_.empty() && std::none_of(stops_.begin(), stops_.end(), stop_due)) return std::nullopt;
  const Snapshot<Real> moment = snapshot(wanted);
  if (const auto bad = fault(moment.state())) return good_ ? fall_back() : *bad;
  std::optional<StopReason> reason;
  for (ScheduledStop& stop : stops_) {
    if (!stop_due(stop)) continue;
    const auto found = stop.check.look(moment);
    if (found && !reason) reason = found;
  }
  show(moment);
  if (reason) return stopped(*reason);
  return std::nullopt;
}

template <class Real> void Simulation<Real>::show(const Snapshot<Real>& moment) {
  const bool recording = std::any_of(monitors_.begin(), monitors_.end(), [](const Scheduled& s) { return s.records; });
  bool last = false;
  for (Scheduled* one : looking_) {
    last = last || one->looks_last;
    if (one->looks_last) continue;
    const Spent spent("monitor", one->name);
    one->monitor.observe(moment);
    if (!recording) continue;
    const std::vector<Series> series = one->monitor.series();
    if (series.empty()) continue;
    const Sample sample{one->name, moment.step(), moment.time(), series, one->monitor.scale()};
    for (auto& other : monitors_) {
      if (!other.records) continue;
      const Spent writing("monitor", other.name);
      other.monitor.record(sample);
    }
  }
  if (!last) return;
  for (auto& writer : monitors_) {
    const Spent spent("monitor", writer.name);
    writer.monitor.flush();
  }
  for (Scheduled* one : looking_) {
    const Spent spent("monitor", one->name);
    if (one->looks_last) one->monitor.observe(moment);
  }
}

template <class Real> std::int64_t Simulation<Real>::next_cut(std::int64_t end) const {
  std::int64_t cut = std::min(end, step() + chunk_);
  for (const auto& scheduled : monitors_) {
    if (scheduled.schedule.by_steps()) cut = std::min(cut, scheduled.schedule.next(step()));
    const bool between = scheduled.schedule.by_time() && raw_.clock().mode() == ClockMode::fixed;
    if (between) cut = std::min(cut, step_of_look(scheduled).step);
  }
  for (const auto& stop : stops_) cut = std::min(cut, detail::next_multiple(step(), stop.steps));
  return cut;
}

template <class Real> std::optional<Outcome> Simulation<Real>::fault(const ParticleSystem<Real>& s) const {
  const std::optional<Failure> found = not_finite(s);
  return found ? std::optional<Outcome>(failed(*found)) : std::nullopt;
}

template <class Real> std::optional<Outcome> Simulation<Real>::settled_fault() {
  integrator_.settle(raw_, copy_, {}, shown_at_, true);
  return fault(copy_);
}

template <class Real> Outcome Simulation<Real>::outcome(Outcome::Kind kind, std::string message) const {
  return {kind, step(), time(), {}, {}, std::move(message)};
}

template <class Real> Outcome Simulation<Real>::stopped(const StopReason& reason) const {
  Outcome result = outcome(Outcome::Kind::stopped, reason.message);
  result.particle =
      ParticleRef{reason.particle, raw_.ids()[static_cast<std::size_t>(reason.particle)], raw_.name(reason.particle)};
  return result;
}

template <class Real> Outcome Simulation<Real>::failed(const Failure& failure) const {
  Outcome result = outcome(failure.kind, failure.message);
  result.quantity = failure.quantity;
  if (failure.particle >= 0) {
    result.particle = ParticleRef{failure.particle, raw_.ids()[static_cast<std::size_t>(failure.particle)],
                                  raw_.name(failure.particle)};
  }
  return result;
}

template <class Real> const ParticleSystem<Real>& Simulation<Real>::particles() {
  integrator_.settle(raw_, copy_, {}, shown_at_, true);
  return copy_;
}

template <class Real> void Simulation<Real>::begin_edit(std::optional<double> at) {
  integrator_.settle(raw_, copy_, {}, at, true);
  shown_at_.reset();
  raw_.assign_state(copy_);
  raw_.phase() = Phase{};
  raw_.keep_low_words(false);
}

template <class Real> void Simulation<Real>::end_edit() {
  if (raw_.size() == 0 && raw_.variables().empty()) {
    throw Error("the edit has left no particles; a run needs at least one");
  }
  check_state(integrator_.claims());
  raw_.trim();
  take_edited();
  copy_ = mapped_ = ParticleSystem<Real>(raw_.units());  // the next look makes them anew
  for (auto& stop : stops_) stop.check.forget();
  for (auto& scheduled : monitors_) scheduled.monitor.forget();
}

/// Lets the integrator begin anew from where the particles stand.
template <class Real> void Simulation<Real>::take_edited() {
  integrator_.bind(raw_);
  if (integrator_.claims().second_words) detail::keep_second_words(copy_, raw_);
}

template <class Real> void Simulation<Real>::change_step(double dt) {
  detail::checked_step(dt);
  if (raw_.clock().mode() == ClockMode::free) {
    throw Error(fmt::format("method '{}' chooses its steps itself; they cannot be set", integrator_.claims().method));
  }
  for (const auto& scheduled : monitors_) {
    const detail::Looks& looks = scheduled.schedule;
    if (looks.interval == 0 && looks.times.empty() && looks.first == 0) continue;
    throw Error(fmt::format("monitor '{}' samples {}, which a new step would shift; attach it {}", scheduled.name,
                            detail::when_in_time(looks), detail::how_without_time(looks)));
  }
  edit_at(std::nullopt, [&](ParticleSystem<Real>& particles) {
    const double now = time();
    particles.clock() = Clock<Real>::fixed(now - static_cast<double>(step()) * dt, dt, step());
  });
}

template class Simulation<double>;
template class Simulation<Quad>;

}  // namespace noether

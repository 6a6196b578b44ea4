#pragma once
/// Definitions of integrators/wisdom_holman.hpp for bodies in lanes; included by it.

#include "integrators/wisdom_holman.hpp"

#include <algorithm>
#include <cmath>

namespace noether {

/// Whether bodies in lanes have all forces beside their own: none, or `gr_potential` alone.
template <class Real, class F> bool WisdomHolman<Real, F>::forces_in_lanes(const ParticleSystem<Real>& s) {
  if constexpr (may_have_lanes) {
    const GrPotential* relativity = nullptr;
    if constexpr (std::is_same_v<F, GrPotential>) relativity = &forces_;
    if constexpr (std::is_same_v<F, Sum<GrPotential>>) {
      forces_.for_each([&](const GrPotential& one) { relativity = &one; });
    }
    if constexpr (std::is_same_v<F, ForceField<double>>) {
      if (forces_.terms().size() == 1) relativity = forces_.terms()[0].template as<GrPotential>();
      if (relativity == nullptr) return forces_.terms().empty();
    }
    if (relativity != nullptr) {
      const double ratio = mu_of_primary(*relativity, s) / speed_of_light_in(s, relativity->c, "gr_potential");
      planets_.bend = 6 * ratio * ratio;
    }
    return true;
  } else {
    return false;
  }
}

/// Puts planets and tracers into lanes where they can be, in the present order.
template <class Real, class F> void WisdomHolman<Real, F>::bind_lanes() {
  if constexpr (may_have_lanes) {
    lanes_ = {};
    tracers_ = {};
    planets_.order.assign(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(massive()));
    if (scaled() || !lanes_have_forces_ || !PlanetLanes::can_take(planets_)) return;
    lanes_.bind(planets_);
    std::vector<std::int64_t> tracers(order_.begin() + static_cast<std::ptrdiff_t>(massive()), order_.end());
    std::vector<int> levels;
    for (const std::int64_t i : tracers) levels.push_back(static_cast<int>(within(static_cast<Index>(i))));
    tracers_.bind(planets_, tracers, levels);
    watch_for_encounters();
  }
}

template <class Real, class F> void WisdomHolman<Real, F>::watch_for_encounters() {
  if constexpr (may_have_lanes) {
    lanes_.watch([&](Index i, Index j) { return encounters_.square_of_news(i, j); });
    tracers_.watch_from(encounters_);
  }
}

/// Whole steps. Bodies stay in lanes meanwhile where they are in lanes and the word has no other letters.
template <class Real, class F>
Advance WisdomHolman<Real, F>::run(const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span) {
  if constexpr (may_have_lanes) {
    const auto in_lanes = [&](const TimedStage<Real>& stage) { return letter_in_lanes(stage.letter); };
    const auto& stages = word.stages();
    if (lanes_.bound() && std::all_of(stages.begin(), stages.end(), in_lanes)) return run_in_lanes(word, s, span);
  }
  return walk_letters(*this, word, s, span, [&](char letter, const Real& h) { flow(letter, s, h); });
}

template <class Real, class F>
template <class>
Advance WisdomHolman<Real, F>::run_in_lanes(const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span) {
  const auto walk_planets = [&](const Span& part) {
    lanes_.load(s);
    const Advance done =
        walk_letters(*this, word, s, part, [&](char letter, const Real& h) { flow_of_lanes(letter, s, h); });
    lanes_.store(s);
    return done;
  };
  if (!has_tracers()) return walk_planets(span);

  // Planets go some steps ahead, and tracers follow.
  const auto kicks = static_cast<std::size_t>(std::count_if(
      word.stages().begin(), word.stages().end(), [](const TimedStage<Real>& stage) { return stage.letter == 'B'; }));
  const std::size_t numbers = kicks * PlanetPath::numbers_of_kick(jacobi(), massive() - 1);
  std::int64_t ahead = TracerLanes::steps_at_once(std::max<std::size_t>(numbers, 1));
  path_.reserve(static_cast<std::size_t>(ahead) * word.stages().size(), static_cast<std::size_t>(ahead) * numbers,
                massive() - 1);
  Advance done;
  while (done.steps < span.steps && done.failure == nullptr && !(done.steps > 0 && span.asked_to_stop())) {
    keep_before_steps(s);
    path_.clear();
    const Advance part =
        walk_planets({.steps = std::min(ahead, span.steps - done.steps), .limit = span.limit, .stop = span.stop});
    const auto lost = tracers_.follow(s, path_, encounters_);
    const std::int64_t good = lost ? lost->step - before_.clock.step() + 1 : part.steps;
    if (good < part.steps) {  // the run ends there
      go_back(s);
      ahead = good;
      continue;
    }
    follow_planets(s, lost);
    done.steps += part.steps;
    if (failure_) done.failure = &*failure_;
  }
  return done;
}

/// Scratch columns keep the particles.
template <class Real, class F>
template <class>
void WisdomHolman<Real, F>::keep_before_steps(const ParticleSystem<Real>& s) {
  pulled_.reset();
  positions_ = s.positions();
  along_ = s.velocities();
  if (const auto* low = s.low_words()) acceleration_ = low->x, other_ = low->v;
  before_.clock = s.clock();
  before_.phase = s.phase();
  before_.evaluations = evaluations_;
  before_.closest = encounters_.closest();
  before_.failure = failure_;
  lanes_.give(before_.predictions);
}
template <class Real, class F> template <class> void WisdomHolman<Real, F>::go_back(ParticleSystem<Real>& s) {
  s.positions() = positions_;
  s.velocities() = along_;
  if (auto* low = s.low_words()) low->x = acceleration_, low->v = other_;
  s.clock() = before_.clock;
  s.phase() = before_.phase;
  evaluations_ = before_.evaluations;
  encounters_.go_back(before_.closest);
  failure_ = before_.failure;
  lanes_.take(before_.predictions);
  lanes_.watch([&](Index i, Index j) { return encounters_.square_of_news(i, j); });
}

/// What is left to do where tracers have followed the planets.
template <class Real, class F>
template <class>
void WisdomHolman<Real, F>::follow_planets(ParticleSystem<Real>& s, const std::optional<TracerLanes::Lost>& lost) {
  if (!observing_) {
    tracers_.keep_predictions();
    tracers_.watch_from(encounters_);
  }
  if (lost) fail(s, lost->particle);
}

/// One flow of the planets that the lanes hold already, and of the center of mass.
template <class Real, class F>
template <class>
void WisdomHolman<Real, F>::flow_of_lanes(char letter, ParticleSystem<Real>& s, const Real& h) {
  PlanetPath* const path = has_tracers() ? &path_ : nullptr;
  path_.at_step(s.clock().step());
  if (letter == 'A') {
    s.shift(0, h * std::as_const(s).velocities()[0], Vec3<Real>::Zero());
    const Index failed = lanes_.drift(h, observing_, path);
    if (observing_) return;
    evaluations_.kepler += s.size() - 1;
    if (failed >= 0) fail(s, failed);
    return;
  }
  begin_kick(s);
  moment_ = static_cast<double>(s.clock().time());
  if (letter != 'B') return kernel_of_lanes(letter, s, h);
  const bool near = lanes_.kick({.h = h, .time = moment_, .noting = noting_}, observing_, path);
  if (observing_) return;
  ++evaluations_.force;
  if (near && noting_) note_near();
}

/// The kicks of kernels, as `gradient_kick` and `lazy_kick` make them.
template <class Real, class F>
template <class>
void WisdomHolman<Real, F>::kernel_of_lanes(char letter, ParticleSystem<Real>& s, const Real& h) {
  const Real dt(s.clock().dt());
  if (!observing_) evaluations_.force += lanes_.knows_forces() && letter == 'G' ? 1 : 2;
  const bool near = lanes_.accelerate(letter == 'G' ? Real(1) : dt * dt / Real(12));
  if (near && noting_ && !observing_) note_near();
  if (letter == 'G') {
    lanes_.kick_by_gradient(Real(2) * h * dt * dt);
  } else {
    lanes_.kick_beside(h);
  }
}

/// Takes down encounters of planets in the last kick.
template <class Real, class F> template <class> void WisdomHolman<Real, F>::note_near() {
  lanes_.for_pairs([&](Index i, Index j, double r2, double nearer2) {
    if (encounters_.near(i, j, r2, nearer2))
      encounters_.note(std::max(i, j), std::min(i, j), r2, nearer2, moment_, backward_);
  });
  lanes_.watch([&](Index i, Index j) { return encounters_.square_of_news(i, j); });
}

/// The same of bodies in the columns.
template <class Real, class F>
template <class>
void WisdomHolman<Real, F>::flow_in_lanes(char letter, ParticleSystem<Real>& s, const Real& h) {
  path_.clear();
  lanes_.load(s);
  flow_of_lanes(letter, s, h);
  lanes_.store(s, letter == 'A' || !jacobi());
  if (has_tracers()) follow_planets(s, tracers_.follow(s, path_, encounters_));
}

/// Positions in the middle of a kick, behind the first half of the jump; in Jacobi coordinates those there are.
template <class Real, class F>
const VectorColumn<Real>& WisdomHolman<Real, F>::middle_of_kick(const ParticleSystem<Real>& s, const Real& h) {
  if (jacobi()) return s.positions();
  const Vec3<Real> shift = half_jump(s, h);
  along_ = s.positions();
  for (Index i = 1; i < s.size(); ++i) along_.add(i, shift);
  return along_;
}

/// A flow with its action: that of arcs from their universal variables, that of kicks from the potential letter by
/// letter.
template <class Real, class F>
template <class>
Real WisdomHolman<Real, F>::action_in_lanes(char letter, ParticleSystem<Real>& s, const Real& h) {
  using std::sqrt;
  const auto& c = std::as_const(s);
  Real action(0);
  if (letter == 'A') {
    for (std::size_t k = 1; k < massive(); ++k) {
      const auto i = static_cast<std::size_t>(at(k));
      const Real speed2 = norm2(c.velocities()[at(k)]), r = sqrt(norm2(c.positions()[at(k)]));
      action += reduced_[i] * h * (speed2 / Real(2) - g_ * circled_[i] / r);
    }
    action += h * interior_.back() * norm2(c.velocities()[0]) / Real(2);
    flow(letter, s, h);
    for (std::size_t k = 1; k < massive(); ++k) {
      const auto i = static_cast<std::size_t>(at(k));
      action += Real(2) * reduced_[i] * g_ * circled_[i] * lanes_.arc(k - 1);
    }
    return action;
  }
  if (letter == 'G') {
    const Real dt(s.clock().dt());
    flow(letter, s, h);
    for (std::size_t k = 1; k < massive(); ++k)
      action += reduced_[static_cast<std::size_t>(at(k))] * norm2(lanes_.along(k - 1));
    return h * dt * dt * action;
  }
  const bool observing = std::exchange(observing_, true);  // this look at the forces is not counted
  begin_kick(s);
  action -= h * accelerate(middle_of_kick(c, h), s.clock(), true);
  observing_ = observing;
  // J is momentum^2/2 m_0, and half a jump h/2 momentum/m_0.
  const auto jump_action = [&] { return jacobi() || h == Real(0) ? Real(0) : masses_[0] * norm2(half_jump(c, h)) / h; };
  action += jump_action();
  flow(letter, s, h);
  return action + jump_action();
}

}  // namespace noether

#pragma once
/// How integrators/wisdom_holman.hpp has its planets moved in lanes; included by it.

#include "integrators/wisdom_holman.hpp"

#include <algorithm>
#include <utility>

namespace noether {

/// Whole steps. Planets stay in lanes meanwhile where all bodies are there and have no other letters.
template <class Real, class F>
Advance WisdomHolman<Real, F>::run(const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span) {
  if constexpr (may_have_lanes) {
    const auto in_lanes = [](const TimedStage<Real>& stage) { return stage.letter == 'A' || stage.letter == 'B'; };
    const auto& stages = word.stages();
    if (lanes_.bound() && !has_tracers() && std::all_of(stages.begin(), stages.end(), in_lanes)) {
      lanes_.load(s);
      const Advance done =
          walk_letters(*this, word, s, span, [&](char letter, const Real& h) { flow_of_lanes(letter, s, h); });
      lanes_.store(s);
      return done;
    }
  }
  return walk_letters(*this, word, s, span, [&](char letter, const Real& h) { flow(letter, s, h); });
}

/// One flow of the planets that the lanes hold already, and of the center of mass.
template <class Real, class F>
void WisdomHolman<Real, F>::flow_of_lanes(char letter, ParticleSystem<Real>& s, const Real& h) requires may_have_lanes {
  if (letter == 'A') {
    s.shift(0, h * std::as_const(s).velocities()[0], Vec3<Real>::Zero());
    const Index failed = lanes_.drift(h, observing_);
    if (observing_) return;
    evaluations_.kepler += static_cast<Index>(massive()) - 1;
    if (failed >= 0) fail(s, failed);
    return;
  }
  const bool near = lanes_.kick(h, observing_);
  if (observing_) return;
  if (!has_tracers()) ++evaluations_.force;
  if (!near) return;
  moment_ = static_cast<double>(s.clock().time());
  lanes_.for_pairs([&](Index i, Index j, double r2, double nearer2) {
    encounters_.note(std::max(i, j), std::min(i, j), r2, nearer2, moment_);
  });
  watch_for_encounters();
}

/// The same of planets in the columns; tracers go letter by letter.
template <class Real, class F>
void WisdomHolman<Real, F>::flow_in_lanes(char letter, ParticleSystem<Real>& s, const Real& h) requires may_have_lanes {
  if (has_tracers() && letter == 'A') arcs(s, h, false, static_cast<Index>(massive()));
  if (has_tracers() && letter == 'B') kick_tracers(s, h);
  lanes_.load(s);
  flow_of_lanes(letter, s, h);
  lanes_.store(s, letter == 'A' || !jacobi());
  if (has_tracers() && letter == 'B' && !jacobi()) {
    const Vec3<Real> shift = half_jump(s, h);
    for (Index i = static_cast<Index>(massive()); i < s.size(); ++i) s.shift(i, shift, Vec3<Real>::Zero());
  }
}

/// What the jump over h/2 moves all bodies by in democratic coordinates.
template <class Real, class F>
Vec3<Real> WisdomHolman<Real, F>::half_jump(const ParticleSystem<Real>& s, const Real& h) const {
  Vec3<Real> momentum = Vec3<Real>::Zero();
  for (std::size_t k = 1; k < massive(); ++k) momentum += masses_[k] * s.velocities()[static_cast<Index>(k)];
  return h / (Real(2) * masses_[0]) * momentum;
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

/// Half a jump and the kick of tracers, before the planets have theirs.
template <class Real, class F> void WisdomHolman<Real, F>::kick_tracers(ParticleSystem<Real>& s, const Real& h) {
  const auto& c = std::as_const(s);
  accelerate(middle_of_kick(c, h), s.clock(), false);
  const Vec3<Real> shift = jacobi() ? Vec3<Real>(Vec3<Real>::Zero()) : half_jump(c, h);
  for (Index i = static_cast<Index>(massive()); i < s.size(); ++i)
    s.shift(i, shift, h * std::as_const(acceleration_)[i]);
}

/// A flow with its action: that of arcs from their universal variables, that of kicks from the potential letter by
/// letter.
template <class Real, class F>
Real WisdomHolman<Real, F>::action_in_lanes(char letter, ParticleSystem<Real>& s,
                                            const Real& h) requires may_have_lanes {
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
  const bool observing = std::exchange(observing_, true);  // this look at the forces is not counted
  action -= h * accelerate(middle_of_kick(c, h), s.clock(), true);
  observing_ = observing;
  // J is momentum^2/2 m_0, and half a jump h/2 momentum/m_0.
  const auto jump_action = [&] { return jacobi() || h == Real(0) ? Real(0) : masses_[0] * norm2(half_jump(c, h)) / h; };
  action += jump_action();
  flow(letter, s, h);
  return action + jump_action();
}

}  // namespace noether

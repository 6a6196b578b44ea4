#pragma once
/// Definitions of integrators/shearing_sheet.hpp; included by it.

#include "integrators/shearing_sheet.hpp"

#include "numbers/parallel.hpp"
#include "numbers/simd_loop.hpp"

#include <algorithm>

namespace noether {

template <class F, class Real> void ShearingSheet<F, Real>::bind(ParticleSystem<Real>& s) {
  if (s.box().is_periodic()) {
    throw Error("a shearing sheet does not support a periodic box; take the box out");
  }
  kicks_.bind(s);
  forces_act_ = !std::is_same_v<F, Sum<>>;
  if constexpr (requires(const F& f) { f.terms().empty(); }) forces_act_ = !kicks_.forces().terms().empty();
}

template <class F, class Real> const Epicycle<Real>& ShearingSheet<F, Real>::epicycle(const Real& h) {
  if constexpr (remembers) {
    const auto end = known_.begin() + static_cast<std::ptrdiff_t>(count_);
    const auto found = std::find_if(known_.begin(), end, [&](const Known& known) { return known.h == h; });
    if (found != end) return found->epicycle;
  }
  Known& place = known_[next_];
  next_ = (next_ + 1) % known_.size();
  count_ = std::min(count_ + 1, known_.size());
  place = {h, Epicycle<Real>(rates_, h)};
  return place.epicycle;
}

template <class F, class Real>
void ShearingSheet<F, Real>::move(ParticleSystem<Real>& s, const Epicycle<Real>& epicycle) {
  kicks_.note_move();
  if constexpr (std::is_same_v<Real, double>) {
    if (s.low_words() == nullptr && !epicycle.turns()) {
      auto& x = s.positions();
      auto& v = s.velocities();
      const auto move = simd_loop<Epicycle<double>::move>();
      for_blocks(s.size(), [&](Index begin, Index end) {
        move(epicycle, x.component(0), x.component(1), x.component(2), v.component(0), v.component(1), v.component(2),
             begin, end);
      });
      return;
    }
  }
  for (Index i = 0; i < s.size(); ++i) {
    const auto change = epicycle.change(std::as_const(s).positions()[i], std::as_const(s).velocities()[i]);
    s.shift(i, change.x, change.v);
  }
  s.moved();
}

template <class F, class Real> void ShearingSheet<F, Real>::flow(char letter, ParticleSystem<Real>& s, const Real& h) {
  if (letter == 'A') return move(s, epicycle(h));
  if (forces_act_) kicks_.flow(letter, s, h);
}

template <class F, class Real>
Real ShearingSheet<F, Real>::flow_with_action(char letter, ParticleSystem<Real>& s, const Real& h) {
  if (letter != 'A') return forces_act_ ? kicks_.flow_with_action(letter, s, h) : Real(0);
  const Epicycle<Real>& epicycle = this->epicycle(h);
  const Real rate = Real(2) * Real(rates_.Omega);
  // H is quadratic in q and p, and v_y + 2 Omega x stays.
  const Real action = sum_over<Real>(s.size(), [&](Index i) {
    const Vec3<Real> x = std::as_const(s).positions()[i], v = std::as_const(s).velocities()[i];
    const auto change = epicycle.change(x, v);
    const Vec3<Real> p(v[0] + change.v[0], v[1] + rate * x[0], v[2] + change.v[2]);
    const Real gain = dot(p, change.x) + (change.v[0] * x[0] + change.v[2] * x[2]);
    return Real(s.masses()[i] * gain / Real(2));
  });
  move(s, epicycle);
  return action;
}

template <class F, class Real> void ShearingSheet<F, Real>::close(ParticleSystem<Real>& s) {
  if (!shows_momenta_) return;
  const Real rate = Real(2) * Real(rates_.Omega);
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<Real> x = std::as_const(s).positions()[i];
    s.velocities().add(i, Vec3<Real>(Real(0), rate * x[0], Real(0)));
  }
}

template <class F, class Real> EnergyTerms<Real> ShearingSheet<F, Real>::energy(const ParticleSystem<Real>& s) {
  EnergyTerms<Real> energy = kicks_.energy(s);
  energy.potential += sum_over<Real>(
      s.size(), [&](Index i) { return Real(s.masses()[i] * frame_.potential(Vec3<Real>(s.positions()[i]))); });
  return energy;
}

template <class F, class Real>
void ShearingSheet<F, Real>::accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
  kicks_.accelerations(s, a);
  for (Index i = 0; i < s.size(); ++i) {
    a.add(i, frame_.acceleration(Vec3<Real>(s.positions()[i]), Vec3<Real>(s.velocities()[i])));
  }
}

}  // namespace noether

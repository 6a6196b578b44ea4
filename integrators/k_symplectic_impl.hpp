#pragma once
/// Definitions of integrators/k_symplectic.hpp; included by it.

#include "integrators/k_symplectic.hpp"

#include "engine/sums.hpp"
#include "integrators/methods/line_table.hpp"
#include "integrators/scheme.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace noether {

template <class F, class Real>
KSymplectic<F, Real>::KSymplectic(F forces, KSymplecticOptions options)
    : Base(forces, "k_symplectic"), on_lines_(fields_among(forces), "k_symplectic"), options_(options) {
  options_.check();
  const GaussNodes gauss = gauss_nodes(static_cast<int>(options_.nodes));
  for (std::size_t k = 0; k < gauss.c.size(); ++k) {
    places_.push_back(detail::weight_in<Real>(gauss.c[k]));
    weights_.push_back(detail::weight_in<Real>(gauss.b[k]));
  }
}

template <class F, class Real> void KSymplectic<F, Real>::bind(ParticleSystem<Real>& s) {
  forces_.bind(s);
  there_ = s;
  there_.keep_low_words(false);
  on_lines_.bind(there_);
  integrals_ = VectorColumn<Real>(s.size());
  momenta_.assign(static_cast<std::size_t>(s.size()), Real(0));
  on_lines_.evaluate(there_, false, true);
  const std::optional<Failure>& failure = on_lines_.last_failure();
  no_momenta_.clear();
  if (failure && failure->quantity == "vector potential")
    no_momenta_ = failure->message + ", so momenta m v + q A are not known";
}

template <class F, class Real> void KSymplectic<F, Real>::close(ParticleSystem<Real>& s) {
  if (!shows_momenta_) return;
  on_lines_.evaluate(s, false, true);
  for (Index i = 0; i < s.size(); ++i) {
    const Real m = s.masses()[i];
    if (m != Real(0)) s.velocities().add(i, Vec3<Real>(on_lines_.momentum(i) / m));
  }
}

template <class F, class Real> void KSymplectic<F, Real>::flow(char letter, ParticleSystem<Real>& s, const Real& h) {
  if (letter != 'B') return move_along(letter - 'X', s, h, false);
  forces_.evaluate(s, false);
  s.advance_velocities(h, forces_.accelerations());
  if (!observing_) forces_.count();
}

template <class F, class Real>
Real KSymplectic<F, Real>::flow_with_action(char letter, ParticleSystem<Real>& s, const Real& h) {
  if (letter == 'B') {
    forces_.evaluate(s, true);
    const Real potential = forces_.potential();
    flow(letter, s, h);
    return -h * potential;
  }
  const int axis = letter - 'X';
  const auto& v = std::as_const(s).velocities();
  move_along(axis, s, h, true);
  return h * sum_over<Real>(s.size(), [&](Index i) {
           const Real along = v[i][axis];  // the same before and after
           return along * (s.masses()[i] * along / Real(2) + momenta_[static_cast<std::size_t>(i)]);
         });
}

template <class F, class Real>
void KSymplectic<F, Real>::move_along(int axis, ParticleSystem<Real>& s, const Real& h, bool momenta) {
  // Means of Omega over the line of each particle.
  integrals_.set_zero();
  if (momenta) std::fill(momenta_.begin(), momenta_.end(), Real(0));
  there_.clock() = s.clock();
  for (std::size_t node = 0; node < places_.size(); ++node) {
    const Real part = places_[node] * h;
    if (axis == 2) there_.clock().set_fraction(s.clock().fraction() + part / Real(s.clock().dt()));
    for (Index i = 0; i < s.size(); ++i) {
      Vec3<Real> x = std::as_const(s).positions()[i];
      x[axis] += part * std::as_const(s).velocities()[i][axis];
      there_.positions().set(i, x);
    }
    there_.moved();
    on_lines_.evaluate(there_, false, momenta);
    for (Index i = 0; i < s.size(); ++i) {
      integrals_.add(i, Vec3<Real>(weights_[node] * on_lines_.rate(i)));
      if (momenta) momenta_[static_cast<std::size_t>(i)] += weights_[node] * on_lines_.momentum(i)[axis];
    }
  }
  for (Index i = 0; i < s.size(); ++i) {
    Vec3<Real> way = Vec3<Real>::Zero();
    way[axis] = h * std::as_const(s).velocities()[i][axis];
    s.shift(i, way, cross(way, Vec3<Real>(std::as_const(integrals_)[i])));
  }
  s.moved();
  if (observing_) return;
  forces_.note_move();
  forces_.count_beside(options_.nodes);
}

template <class F, class Real>
void KSymplectic<F, Real>::accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
  forces_.evaluate(s, false);
  if (a.size() != s.size()) a = VectorColumn<Real>(s.size());
  for (Index i = 0; i < s.size(); ++i) {
    a.set(i, Vec3<Real>(forces_.acceleration(i) + cross(Vec3<Real>(s.velocities()[i]), forces_.rate(i))));
  }
}

}  // namespace noether

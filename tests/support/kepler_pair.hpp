#pragma once
/// Two bodies on an orbit of semi-major axis 1 about their center, G (m1 + m2) = 1: what projections are measured on.

#include "engine/simulation.hpp"

#include <cmath>
#include <numbers>

namespace noether::test {

/// The period of the orbit.
inline constexpr double turn = 2 * std::numbers::pi;

/// At the pericenter, the second body on the positive x axis of the first. @param m  the mass of the first
template <class Real = double> ParticleSystem<Real> kepler_pair(double e = 0.6, double m = 0.75) {
  const double r = 1 - e, v = std::sqrt((1 + e) / (1 - e));
  ParticleSystem<double> s;
  s.add("one", m, {-(1 - m) * r, 0, 0}, {0, -(1 - m) * v, 0});
  s.add("other", 1 - m, {m * r, 0, 0}, {0, m * v, 0});
  return s.as<Real>();
}

/// From the first body to the second.
template <class Real> Vec3<Real> apart(const ParticleSystem<Real>& s) {
  return Vec3<Real>(s.positions()[1]) - Vec3<Real>(s.positions()[0]);
}

/// How far whole turns end from where they began.
template <class Real> double error_after_turns(const ParticleSystem<Real>& s, double e = 0.6) {
  const Vec3<Real> off = apart(s) - Vec3<Real>(Real(1) - Real(e), Real(0), Real(0));
  return std::sqrt(static_cast<double>(norm2(off)));
}

/// Energy of the pair.
template <class Real> Real energy_of(const ParticleSystem<Real>& s) {
  using std::sqrt;
  Real kinetic(0);
  for (Index i = 0; i < 2; ++i) kinetic += s.masses()[i] * norm2(Vec3<Real>(s.velocities()[i])) / Real(2);
  return kinetic - s.masses()[0] * s.masses()[1] / Real(sqrt(norm2(apart(s))));
}

/// Angular momentum of the pair about the origin.
template <class Real> Vec3<Real> angular_momentum_of_pair(const ParticleSystem<Real>& s) {
  Vec3<Real> sum = Vec3<Real>::Zero();
  for (Index i = 0; i < 2; ++i)
    sum += s.masses()[i] * cross(Vec3<Real>(s.positions()[i]), Vec3<Real>(s.velocities()[i]));
  return sum;
}

}  // namespace noether::test

#pragma once
/// Planetary systems that tests share, built in any number type.

#include "engine/particle_system.hpp"

namespace noether::test {

/// Sun, Jupiter ... Pluto about their barycentre, in au, day, Msun.
/// @source HairerLubichWanner2006, section I.2.4
template <class Real = double> ParticleSystem<Real> outer_planets() {
  ParticleSystem<double> s(unit_system("solar"));
  s.add("Sun", 1.00000597682, {0, 0, 0}, {0, 0, 0});
  s.add("Jupiter", 0.000954786104043, {-3.5023653, -3.8169847, -1.5507963}, {0.00565429, -0.00412490, -0.00190589});
  s.add("Saturn", 0.000285583733151, {9.0755314, -3.0458353, -1.6483708}, {0.00168318, 0.00483525, 0.00192462});
  s.add("Uranus", 0.0000437273164546, {8.3101420, -16.2901086, -7.2521278}, {0.00354178, 0.00137102, 0.00055029});
  s.add("Neptune", 0.0000517759138449, {11.4707666, -25.7294829, -10.8169456}, {0.00288930, 0.00114527, 0.00039677});
  s.add("Pluto", 1 / 1.3e8, {-15.5387357, -25.2225594, -3.1902382}, {0.00276725, -0.00170702, -0.00136504});
  move_to_barycenter(s);
  return s.as<Real>();
}

/// G of the outer planets [au^3/Msun/day^2].
inline constexpr double outer_G = 2.95912208286e-4;

/// The outer planets with a ring of `n` tracers between 2 and 4 au.
inline ParticleSystem<double> planets_with_tracers(int n) {
  ParticleSystem<double> s = outer_planets();
  for (int k = 0; k < n; ++k) {
    const double r = 2 + 2.0 * k / n, v = std::sqrt(outer_G / r), angle = 2.399963 * k;
    s.add("tracer " + std::to_string(k), 0, {r * std::cos(angle), r * std::sin(angle), 0.01 * (k % 7)},
          {-v * std::sin(angle), v * std::cos(angle), 0});
  }
  return s;
}

/// A cloud of `n` bodies of equal mass in a sphere of radius 1, at rest; G = 1. The same for every call.
inline ParticleSystem<double> cloud(int n) {
  ParticleSystem<double> s;
  std::uint64_t state = 88172645463325252ULL;
  const auto next = [&state] {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return static_cast<double>(state >> 11) / 9007199254740992.0 * 2 - 1;
  };
  while (s.size() < n) {
    const Vec3<double> x(next(), next(), next());
    if (norm2(x) < 1) s.add("body " + std::to_string(s.size()), 1.0 / n, x, Vec3<double>::Zero());
  }
  return s;
}

/// Whether second words, or that there are none, are the same.
template <class Real> bool same_low_words(const ParticleSystem<Real>& a, const ParticleSystem<Real>& b) {
  const auto *one = a.low_words(), *other = b.low_words();
  if (one == nullptr || other == nullptr) return one == other;
  for (Index i = 0; i < a.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      if (!(one->x.component(k)[i] == other->x.component(k)[i])) return false;
      if (!(one->v.component(k)[i] == other->v.component(k)[i])) return false;
    }
  }
  return true;
}

/// Whether all positions and velocities are the same numbers, bit for bit (and finite).
template <class Real> bool same_bits(const ParticleSystem<Real>& a, const ParticleSystem<Real>& b) {
  if (a.size() != b.size() || a.clock().step() != b.clock().step()) return false;
  for (Index i = 0; i < a.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      if (!(a.positions().component(k)[i] == b.positions().component(k)[i])) return false;
      if (!(a.velocities().component(k)[i] == b.velocities().component(k)[i])) return false;
    }
  }
  return true;
}

}  // namespace noether::test

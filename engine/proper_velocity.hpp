#pragma once
/// Velocities near that of light: their gammas, and the coordinates in which such particles are kept.

#include "engine/particle_system.hpp"
#include "numbers/real.hpp"

#include <cmath>
#include <cstdint>
#include <type_traits>

namespace noether {

/// `Phase::coordinates` of particles whose velocity column is the proper velocity u = gamma v.
inline constexpr std::uint8_t proper_velocities = 9;

/// Numbers in which v keeps the digits that gamma needs: 1 - v^2/c^2 has none left in doubles.
template <class Real> using FastNumber = std::conditional_t<std::is_same_v<Real, double>, Quad, Real>;

/// A velocity with its low word, if it has one [length/time].
template <class Real> Vec3<FastNumber<Real>> whole_velocity(const ParticleSystem<Real>& s, Index i) {
  using Wide = FastNumber<Real>;
  Vec3<Wide> v;
  for (int k = 0; k < 3; ++k) {
    v[k] = Wide(s.velocities().component(k)[i]);
    if (s.low_words() != nullptr) v[k] += Wide(s.low_words()->v.component(k)[i]);
  }
  return v;
}

/// Sets a velocity, and its low word where the particles keep some.
template <class Real> void set_whole_velocity(ParticleSystem<Real>& s, Index i, const Vec3<FastNumber<Real>>& v) {
  for (int k = 0; k < 3; ++k) {
    const Real high = Real(v[k]);
    s.velocities().component(k)[i] = high;
    if (s.low_words() != nullptr) s.low_words()->v.component(k)[i] = Real(v[k] - FastNumber<Real>(high));
  }
}

/// gamma = 1/sqrt(1 - v^2/c^2)
template <class Wide> Wide gamma_of_velocity(const Vec3<Wide>& v, const Wide& c) {
  using std::sqrt;
  return Wide(1) / sqrt(Wide(1) - norm2(v) / (c * c));
}

}  // namespace noether

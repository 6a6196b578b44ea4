#pragma once
/// An oscillator whose energy is no sum of a kinetic and a potential one.

#include "engine/description.hpp"
#include "integrators/vector_field.hpp"

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace noether {

/// Tao's test of methods for energies that do not separate, from q = -3 at rest by default.
///
///     H = (q^2 + 1) (p^2 + 1) / 2
///
/// From p = 0 it is q = q0 cn(sqrt(1 + q0^2) t), with the modulus k^2 = q0^2 / (1 + q0^2).
/// @source Tao2016
struct NonseparableOscillator {
  double position = -3;  ///< q at the start [1]

  static constexpr auto describe() {
    return part<NonseparableOscillator>(
        "nonseparable_oscillator", "an oscillator whose energy does not part into kinetic and potential energy",
        formula("H = (q^2 + 1) (p^2 + 1) / 2"), source("Tao2016"), quantities("q, p [1]"),
        field<&NonseparableOscillator::position>("position", "1", "q at the start, where p = 0"));
  }

  Index size() const { return 1; }
  std::vector<double> start() const { return {position, 0}; }
  std::vector<std::string> names() const { return {"q", "p"}; }
  std::vector<double> exact(double t) const;

  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    return (q[0] * q[0] + Real(1)) * (p[0] * p[0] + Real(1)) / Real(2);
  }
};

/// By the means of arithmetic and geometry, and back along Landen's transformation.
inline std::vector<double> NonseparableOscillator::exact(double t) const {
  const double rate = std::sqrt(1 + position * position);
  std::array<double, 12> a{}, c{};
  double mean = 1, root = 1 / rate;  // k' of the modulus
  std::size_t n = 0;
  for (c[0] = std::abs(position) / rate, a[0] = 1; c[n] > 1e-17 * a[n] && n + 1 < a.size(); ++n) {
    c[n + 1] = (mean - root) / 2;
    a[n + 1] = (mean + root) / 2;
    root = std::sqrt(mean * root);
    mean = a[n + 1];
  }
  double angle = std::ldexp(a[n] * rate * t, static_cast<int>(n));
  for (; n > 0; --n) angle = (angle + std::asin(c[n] / a[n] * std::sin(angle))) / 2;
  const double sn = std::sin(angle), cn = std::cos(angle);
  const double dn = std::sqrt(1 - position * position / (rate * rate) * sn * sn), q = position * cn;
  return {q, -position * rate * sn * dn / (q * q + 1)};
}

}  // namespace noether

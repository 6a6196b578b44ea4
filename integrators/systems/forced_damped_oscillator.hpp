#pragma once
/// One oscillator, damped and driven, with its closed solution.

#include "engine/description.hpp"
#include "integrators/vector_field.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace noether {

/// A spring with drag, driven by a cosine; from underdamped over critical to overdamped.
///
///     x' = v,   v' = -omega0^2 x - 2 gamma v + amplitude cos(omega t)
///
/// With nothing to drive it, x = e^(-gamma t) cos(omega_d t), omega_d^2 = omega0^2 - gamma^2, only where gamma < omega0
/// and v(0) = -gamma x(0); `exact` holds for any start and any damping.
struct ForcedDampedOscillator {
  double omega0 = 1;     ///< of the spring [1/time]
  double gamma = 0.1;    ///< half the rate of the drag [1/time]
  double amplitude = 1;  ///< of the drive [length/time^2]
  double omega = 0.9;    ///< of the drive [1/time]
  double position = 1;   ///< at the start [length]
  double velocity = 0;   ///< at the start [length/time]

  static constexpr auto describe() {
    return part<ForcedDampedOscillator>(
        "forced_damped_oscillator", "a spring with drag, driven by a cosine",
        formula("x' = v,  v' = -omega0^2 x - 2 gamma v + amplitude cos(omega t)"), source("LandauLifshitz1976"),
        quantities("x [length], v [length/time]"),
        field<&ForcedDampedOscillator::omega0>("omega0", "1/time", "angular frequency of the spring"),
        field<&ForcedDampedOscillator::gamma>("gamma", "1/time", "half the rate of the drag"),
        field<&ForcedDampedOscillator::amplitude>("amplitude", "length/time^2", "amplitude of the drive"),
        field<&ForcedDampedOscillator::omega>("omega", "1/time", "angular frequency of the drive"),
        field<&ForcedDampedOscillator::position>("position", "length", "position at the start"),
        field<&ForcedDampedOscillator::velocity>("velocity", "length/time", "velocity at the start"));
  }
  /// @throws Error  for a spring that is none, or a drag that drives
  void check() const {
    if (!(omega0 > 0))
      refuse_field("omega0", omega0, "is not a valid frequency of a spring; a frequency above 0 is expected");
    if (!(gamma >= 0)) refuse_field("gamma", gamma, "is not a valid drag; 0 or more is expected");
  }

  Index size() const { return 2; }
  std::vector<double> start() const { return {position, velocity}; }
  std::vector<std::string> names() const { return {"x", "v"}; }
  /// The solution that begins at `start()`: x, v.
  std::vector<double> exact(double t) const {
    const auto [x0, v0] = driven(0);
    const auto [xd, vd] = driven(t);
    const auto [x, v] = free(position - x0, velocity - v0, t);
    return {x + xd, v + vd};
  }

  template <class Real> void rates(const Real& t, const Vector<Real>& y, Vector<Real>& dy) const {
    using std::cos;
    dy[0] = y[1];
    dy[1] = Real(amplitude) * cos(Real(omega) * t) - Real(2 * gamma) * y[1] - Real(omega0) * Real(omega0) * y[0];
  }

 private:
  struct State {
    double x, v;
  };
  /// One solution of the driven equation: the steady one; at resonance without drag, the one that grows from rest.
  State driven(double t) const {
    const double detuning = omega0 * omega0 - omega * omega, drag = 2 * gamma * omega;
    const double c = std::cos(omega * t), s = std::sin(omega * t);
    if (detuning == 0 && drag == 0) {
      const double slope = amplitude / (2 * omega);
      return {slope * t * s, slope * (s + omega * t * c)};
    }
    const double size = amplitude / (detuning * detuning + drag * drag);
    const double a = size * detuning, b = size * drag;
    return {a * c + b * s, omega * (b * c - a * s)};
  }
  /// Without a drive, from x and v at time 0.
  State free(double x, double v, double t) const {
    const double decay = std::exp(-gamma * t), square = omega0 * omega0 - gamma * gamma;
    const double w = std::sqrt(std::abs(square)), slope = v + gamma * x;
    if (square > 0) {
      const double c = std::cos(w * t), s = std::sin(w * t);
      return {decay * (x * c + slope / w * s), decay * (v * c - (gamma * slope / w + w * x) * s)};
    }
    if (square == 0) return {decay * (x + slope * t), decay * (v - gamma * slope * t)};
    // Both rates are added to the exponent: cosh alone overflows where the product does not.
    const double slow = std::exp((w - gamma) * t), fast = std::exp(-(w + gamma) * t);
    const double c = (slow + fast) / 2, s = (slow - fast) / 2;
    return {x * c + slope / w * s, v * c + (w * x - gamma * slope / w) * s};
  }
};

}  // namespace noether

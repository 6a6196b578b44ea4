#pragma once
/// Problems with known solutions, written once for every number type, and the shortest way to run an integrator.

#include "engine/particle_system.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/sum.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "tests/support/drivers.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace noether::test {

/// The force of Henon and Heiles on every particle, in the plane, as a user would write it.
///     U = sum m [ (x^2 + y^2)/2 + x^2 y - y^3/3 ]
struct HenonHeilesField {
  std::string name() const { return "henon_heiles"; }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> q = s.positions()[i];
      const Real x = q[0], y = q[1];
      out.acceleration(i, Vec3<Real>(-x - Real(2) * x * y, -y - x * x + y * y, Real(0)));
      if (out.wants_energy()) {
        out.energy(s.masses()[i] * ((x * x + y * y) / Real(2) + x * x * y - y * y * y / Real(3)));
      }
    }
  }
};

/// One particle of mass 1 in the plane.
inline ParticleSystem<double> particle_in_plane(double x, double y, double u, double v) {
  ParticleSystem<double> s;
  s.add("particle", 1.0, {x, y, 0}, {u, v, 0});
  return s;
}

/// Position and velocity of one particle.
template <class Real> struct PhasePoint { Vec3<Real> x, v; };

template <class Real> PhasePoint<Real> motion_of(const ParticleSystem<Real>& s, Index i = 0) {
  return {s.positions()[i], s.velocities()[i]};
}

/// Largest difference of a component.
template <class Real> double distance(const PhasePoint<Real>& a, const PhasePoint<Real>& b) {
  double worst = 0;
  for (int k = 0; k < 3; ++k) {
    worst = std::max(worst, std::fabs(static_cast<double>(a.x[k] - b.x[k])));
    worst = std::max(worst, std::fabs(static_cast<double>(a.v[k] - b.v[k])));
  }
  return worst;
}

template <class Real> double distance(const ParticleSystem<Real>& a, const ParticleSystem<Real>& b) {
  double worst = 0;
  for (Index i = 0; i < a.size(); ++i) worst = std::max(worst, distance(motion_of(a, i), motion_of(b, i)));
  return worst;
}

/// The flow of Henon and Heiles by its Taylor series, degree 40, in steps of 1/8: an error of some ulp per step.
template <class Real> PhasePoint<Real> henon_heiles_flow(PhasePoint<Real> start, double duration) {
  constexpr std::size_t degree = 40;
  const int steps = static_cast<int>(std::ceil(std::fabs(duration) * 8));
  const Real h = Real(duration) / Real(steps);
  for (int step = 0; step < steps; ++step) {
    std::array<Real, degree + 2> x{}, y{};
    x[0] = start.x[0], x[1] = start.v[0], y[0] = start.x[1], y[1] = start.v[1];
    for (std::size_t k = 0; k + 2 < x.size(); ++k) {
      Real xx(0), xy(0), yy(0);
      for (std::size_t j = 0; j <= k; ++j) xx += x[j] * x[k - j], xy += x[j] * y[k - j], yy += y[j] * y[k - j];
      const Real factor = Real(1) / Real(static_cast<double>((k + 1) * (k + 2)));
      x[k + 2] = factor * (-x[k] - Real(2) * xy);
      y[k + 2] = factor * (-y[k] - xx + yy);
    }
    start = {Vec3<Real>::Zero(), Vec3<Real>::Zero()};
    for (std::size_t k = x.size(); k-- > 0;) {
      start.x = h * start.x + Vec3<Real>(x[k], y[k], Real(0));
      if (k > 0) start.v = h * start.v + Real(static_cast<double>(k)) * Vec3<Real>(x[k], y[k], Real(0));
    }
  }
  return start;
}

/// Two bodies of masses 3/4 and 1/4 (G = 1) on a relative orbit of semi-major axis 1, at rest as a whole.
/// @param anomaly  eccentric anomaly at the start; 0 is the pericenter
inline ParticleSystem<double> kepler_pair(double eccentricity, double anomaly = 0) {
  const double b = std::sqrt(1 - eccentricity * eccentricity), rate = 1 / (1 - eccentricity * std::cos(anomaly));
  const Vec3<double> x(std::cos(anomaly) - eccentricity, b * std::sin(anomaly), 0);
  const Vec3<double> v(-rate * std::sin(anomaly), b * rate * std::cos(anomaly), 0);
  ParticleSystem<double> s;
  s.add("primary", 0.75, -0.25 * x, -0.25 * v);
  s.add("secondary", 0.25, 0.75 * x, 0.75 * v);
  return s;
}

/// Relative motion of `kepler_pair` after a time, by Kepler's equation and f and g, from the very state it starts with.
template <class Real> PhasePoint<Real> kepler_motion(const ParticleSystem<Real>& start, const Real& time) {
  using std::abs, std::cos, std::sin, std::sqrt;
  const Vec3<Real> x0 = start.positions()[1] - start.positions()[0], v0 = start.velocities()[1] - start.velocities()[0];
  const Real mu = start.masses()[0] + start.masses()[1], r0 = sqrt(norm2(x0));
  const Real a = Real(1) / (Real(2) / r0 - norm2(v0) / mu), n = sqrt(mu / a) / a;
  const Real e_cos = Real(1) - r0 / a, e_sin = dot(x0, v0) / sqrt(mu * a);
  Real d = n * time;  // what the eccentric anomaly gains
  for (int k = 0; k < 50; ++k) {
    const Real correction =
        (d - e_cos * sin(d) + e_sin * (Real(1) - cos(d)) - n * time) / (Real(1) - e_cos * cos(d) + e_sin * sin(d));
    d -= correction;
    if (abs(correction) < Real(8) * std::numeric_limits<Real>::epsilon()) break;
  }
  const Real r = a * (Real(1) - e_cos * cos(d) + e_sin * sin(d));
  const Real f = Real(1) - a / r0 * (Real(1) - cos(d)), g = time - (d - sin(d)) / n;
  const Real df = -sqrt(mu * a) / (r * r0) * sin(d), dg = Real(1) - a / r * (Real(1) - cos(d));
  return {f * x0 + g * v0, df * x0 + dg * v0};
}

/// Relative motion of particle 1 to particle 0.
template <class Real> PhasePoint<Real> relative_motion(const ParticleSystem<Real>& s) {
  return {s.positions()[1] - s.positions()[0], s.velocities()[1] - s.velocities()[0]};
}

/// x'' = -k x + g cos(omega t + phase) in one dimension, omega^2 != k.
template <class Real>
PhasePoint<Real> driven_motion(const PhasePoint<Real>& start, const HarmonicField& spring,
                               const OscillatingField& drive, const Real& time) {
  using std::cos, std::sin, std::sqrt;
  const Real w0 = sqrt(Real(spring.k)), w = Real(drive.omega), phase = Real(drive.phase);
  const Real amplitude = Real(drive.acceleration[0]) / (w0 * w0 - w * w);
  const Real c = start.x[0] - amplitude * cos(phase), d = (start.v[0] + amplitude * w * sin(phase)) / w0;
  return {Vec3<Real>(c * cos(w0 * time) + d * sin(w0 * time) + amplitude * cos(w * time + phase), Real(0), Real(0)),
          Vec3<Real>(w0 * (d * cos(w0 * time) - c * sin(w0 * time)) - amplitude * w * sin(w * time + phase), Real(0),
                     Real(0))};
}

/// A star and four massive planets on inclined, mildly eccentric orbits (G = 1); masses of planets are `mass` times
/// 1, 0.5, 0.3, 0.2. Not symmetric in any way.
inline ParticleSystem<double> planets(double mass, int count = 4) {
  ParticleSystem<double> s;
  s.add("star", 1.0, {0.01, -0.02, 0.005}, {0.003, 0.001, -0.002});
  const std::array<Vec3<double>, 4> x = {{{1.0, 0.1, 0.05}, {-0.3, 1.7, 0.1}, {-2.2, -1.4, -0.2}, {1.5, -3.8, 0.3}}};
  const std::array<Vec3<double>, 4> v = {
      {{-0.1, 0.98, 0.08}, {-0.73, -0.16, 0.05}, {0.34, -0.51, 0.02}, {0.45, 0.2, -0.04}}};
  const std::array<double, 4> ratio = {1.0, 0.5, 0.3, 0.2};
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    s.add("planet " + std::to_string(k + 1), mass * ratio[k], x[k], v[k]);
  }
  return s;
}

/// Four bodies of similar masses in three dimensions, far from any encounter for a few times the unit (G = 1).
inline ParticleSystem<double> four_bodies() {
  ParticleSystem<double> s;
  s.add("a", 1.0, {0.1, -0.2, 0.3}, {0.1, 0.05, -0.1});
  s.add("b", 0.7, {1.9, 0.4, -0.1}, {-0.1, 0.6, 0.2});
  s.add("c", 0.4, {-1.1, 1.6, 0.5}, {-0.4, -0.5, 0.1});
  s.add("d", 0.2, {-0.7, -2.1, -0.6}, {0.6, -0.2, 0.3});
  return s;
}

/// Three equal bodies on the orbit in the shape of an eight (G = 1), period 6.32591398.
/// @source ChencinerMontgomery2000
inline ParticleSystem<double> figure_eight() {
  ParticleSystem<double> s;
  const Vec3<double> x(0.97000436, -0.24308753, 0), v(-0.93240737, -0.86473146, 0);
  s.add("first", 1.0, x, -0.5 * v);
  s.add("second", 1.0, -x, -0.5 * v);
  s.add("third", 1.0, Vec3<double>::Zero(), v);
  return s;
}

}  // namespace noether::test

namespace noether {

// Compiled once, in problems.cpp.
extern template struct detail::ForceModel<test::HenonHeilesField, double>;
extern template struct detail::ForceModel<test::HenonHeilesField, Quad>;

namespace test {
extern template PhasePoint<Quad> henon_heiles_flow(PhasePoint<Quad>, double);
extern template PhasePoint<double> kepler_motion(const ParticleSystem<double>&, const double&);
extern template PhasePoint<Quad> kepler_motion(const ParticleSystem<Quad>&, const Quad&);
extern template PhasePoint<Quad> driven_motion(const PhasePoint<Quad>&, const HarmonicField&, const OscillatingField&,
                                               const Quad&);
}  // namespace test

}  // namespace noether

#pragma once
/// Lagrangians as users write them, and the shortest way to walk them.

#include "integrators/systems/pendulum.hpp"
#include "integrators/systems/polar_kepler.hpp"
#include "integrators/variational/lagrangian_system.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace noether::test {

/// A mass in the plane, pulled by a centre with a force that is not Kepler's: no coordinate is cyclic.
struct CentralForce {
  Index size() const { return 2; }
  std::vector<double> start() const { return {1.2, -0.1, 0.2, 0.9}; }
  std::vector<Symmetry> symmetries() const {
    return {{"rotation", [](const Eigen::VectorXd& q) { return Eigen::Vector2d(-q[1], q[0]); }}};
  }
  template <class Real> Real lagrangian(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& v) const {
    const Real r2 = q[0] * q[0] + q[1] * q[1];
    return (v[0] * v[0] + v[1] * v[1]) / Real(2) - r2 * r2 / Real(4) - r2;
  }
};

/// A wheel that a motor turns, on a spring that it shakes: time and velocities mixed.
struct Shaken {
  static constexpr bool time_dependent = true;
  Index size() const { return 2; }
  std::vector<double> start() const { return {0.3, -0.2, 0.5, 0.4}; }
  template <class Real> Real lagrangian(const Real& t, const Vector<Real>& q, const Vector<Real>& v) const {
    using std::cos, std::sin;
    return v[0] * v[0] + v[0] * v[1] * cos(q[1]) + v[1] * v[1] + q[0] * v[1] * sin(t) - q[0] * q[0] - cos(q[1] - t);
  }
};

/// A named method over a Lagrangian, `count` steps of h from (q, p) in any precision.
template <class Real, class S>
Vector<Real> walked(const S& system, const char* name, const std::vector<double>& start, double h, long count) {
  LagrangianMotion<S, Real> f(system);
  const MethodChoice choice =
      method(name, {.adaptive = methods::find(name)->adaptive ? std::optional(false) : std::nullopt});
  const auto steps = make_method<Real>(*choice.info, choice.options);
  steps->bind(f);
  Vector<Real> y(static_cast<Index>(start.size()));
  for (Index i = 0; i < y.size(); ++i) y[i] = Real(start[static_cast<std::size_t>(i)]);
  for (long n = 0; n < count; ++n) {
    const StepResult made = steps->step(f, Real(h) * Real(static_cast<double>(n)), y, h);
    if (made.failure) throw Error(made.failure->message);
  }
  return y;
}

template <class Real> double apart(const Vector<Real>& a, const Vector<Real>& b) {
  double worst = 0;
  for (Index i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(static_cast<double>(a[i] - b[i])));
  return worst;
}

}  // namespace noether::test

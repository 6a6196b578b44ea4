#pragma once
/// A pendulum in its angle, by its Lagrangian.

#include "engine/description.hpp"
#include "integrators/vector_field.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace noether {

/// A mass on a rod; the angle is counted from straight down. With a damping the drag of its bearing acts beside the
/// Lagrangian.
///
///     L = m l^2 theta'^2 / 2 + m g l cos(theta),   force = - m l^2 damping theta'
/// @source LandauLifshitz1976
struct SimplePendulum {
  double mass = 1;
  double length = 1;
  double g = 1;        ///< [length/time^2]
  double damping = 0;  ///< [1/time]

  static constexpr auto describe() {
    return part<SimplePendulum>(
        "pendulum", "a pendulum in its angle, by its Lagrangian",
        formula("L = m l^2 theta'^2/2 + m g l cos(theta),  force - m l^2 damping theta'"), source("LandauLifshitz1976"),
        quantities("theta [1], its momentum [mass length^2/time]"),
        field<&SimplePendulum::mass>("mass", "mass", "of the bob"),
        field<&SimplePendulum::length>("length", "length", "of the rod"),
        field<&SimplePendulum::g>("g", "length/time^2", "acceleration by gravity"),
        field<&SimplePendulum::damping>("damping", "1/time", "rate at which the bearing takes momentum"));
  }
  /// @throws Error  for a bob without mass, a rod without length, or a bearing that drives
  void check() const {
    if (!(mass > 0)) refuse_field("mass", mass, "is not a valid mass of a bob; a mass above 0 is expected");
    if (!(length > 0)) refuse_field("length", length, "is not a valid length of a rod; a length above 0 is expected");
    if (!(damping >= 0)) refuse_field("damping", damping, "is not a valid damping; 0 or more is expected");
  }

  Index size() const { return 1; }
  std::vector<double> start() const { return {2, 0.3 * mass * length * length}; }
  std::vector<std::string> names() const { return {"theta", "p_theta"}; }

  template <class Real> Real lagrangian(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& v) const {
    using std::cos;
    return Real(mass * length * length / 2) * v[0] * v[0] + Real(mass * g * length) * cos(q[0]);
  }
  bool forced() const { return damping > 0; }
  template <class Real>
  void force(const Real& /*t*/, const Vector<Real>& /*q*/, const Vector<Real>& v, Vector<Real>& f) const {
    f[0] = Real(-mass * length * length * damping) * v[0];
  }
};

}  // namespace noether

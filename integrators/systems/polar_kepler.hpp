#pragma once
/// Kepler's problem in polar coordinates, by its Lagrangian.

#include "engine/description.hpp"
#include "engine/symmetry.hpp"
#include "integrators/vector_field.hpp"

#include <string>
#include <vector>

namespace noether {

/// A body of mass 1 about a fixed center, in the plane. The angle does not occur in L: its momentum is kept.
///
///     L = (r'^2 + r^2 theta'^2) / 2 + mu / r
/// @source MarsdenWest2001
struct PolarKepler {
  double mu = 1;  ///< [length^3/time^2]

  static constexpr auto describe() {
    return part<PolarKepler>("polar_kepler", "Kepler's problem in polar coordinates, by its Lagrangian",
                             formula("L = (r'^2 + r^2 theta'^2)/2 + mu/r"), source("LandauLifshitz1976"),
                             quantities("r [length], theta [1], p_r [length/time], p_theta [length^2/time]"),
                             field<&PolarKepler::mu>("mu", "length^3/time^2", "G times the mass of the center"));
  }
  /// @throws Error  for a center that repels
  void check() const {
    if (!(mu > 0)) refuse_field("mu", mu, "is not a valid attraction; a number above 0 is expected");
  }

  Index size() const { return 2; }
  std::vector<double> start() const { return {1, 0, 0, 1.2}; }
  std::vector<std::string> names() const { return {"r", "theta", "p_r", "p_theta"}; }
  std::vector<Symmetry> symmetries() const {
    return {{"rotation", [](const Eigen::VectorXd& q) { return Eigen::VectorXd::Unit(q.size(), 1); }}};
  }

  template <class Real> Real lagrangian(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& v) const {
    const Real &r = q[0], across = r * v[1];
    return (v[0] * v[0] + across * across) / Real(2) + Real(mu) / r;
  }
};

}  // namespace noether

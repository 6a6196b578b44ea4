#pragma once
/// A pendulum on a pendulum, in its two angles, by its Lagrangian.

#include "engine/description.hpp"
#include "integrators/vector_field.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace noether {

/// Two bobs on two rods, both angles counted from straight down: chaotic where it swings high.
///
///     L = (m1 + m2) l1^2 th1'^2 / 2 + m2 l2^2 th2'^2 / 2 + m2 l1 l2 th1' th2' cos(th1 - th2)
///         + (m1 + m2) g l1 cos(th1) + m2 g l2 cos(th2)
/// @source LandauLifshitz1976
struct DoublePendulum {
  double mass1 = 1, mass2 = 1;
  double length1 = 1, length2 = 1;
  double g = 1;  ///< [length/time^2]

  static constexpr auto describe() {
    return part<DoublePendulum>(
        "double_pendulum", "a pendulum on a pendulum in its two angles, by its Lagrangian",
        formula("L = (m1 + m2) l1^2 th1'^2/2 + m2 l2^2 th2'^2/2 + m2 l1 l2 th1' th2' cos(th1 - th2) "
                "+ (m1 + m2) g l1 cos(th1) + m2 g l2 cos(th2)"),
        source("LandauLifshitz1976"), quantities("theta_1, theta_2 [1], p_1, p_2 [mass length^2/time]"),
        field<&DoublePendulum::mass1>("mass1", "mass", "of the upper bob"),
        field<&DoublePendulum::mass2>("mass2", "mass", "of the lower bob"),
        field<&DoublePendulum::length1>("length1", "length", "of the upper rod"),
        field<&DoublePendulum::length2>("length2", "length", "of the lower rod"),
        field<&DoublePendulum::g>("g", "length/time^2", "acceleration by gravity"));
  }
  /// @throws Error  for bobs without mass and rods without length
  void check() const {
    if (!(mass1 > 0)) refuse_field("mass1", mass1, "is not a valid mass of a bob; a mass above 0 is expected");
    if (!(mass2 > 0)) refuse_field("mass2", mass2, "is not a valid mass of a bob; a mass above 0 is expected");
    if (!(length1 > 0))
      refuse_field("length1", length1, "is not a valid length of a rod; a length above 0 is expected");
    if (!(length2 > 0))
      refuse_field("length2", length2, "is not a valid length of a rod; a length above 0 is expected");
  }

  Index size() const { return 2; }
  std::vector<double> start() const { return {1, 2, 0, 0}; }
  std::vector<std::string> names() const { return {"theta_1", "theta_2", "p_1", "p_2"}; }

  template <class Real> Real lagrangian(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& v) const {
    using std::cos;
    const Real both = Real(mass1) + Real(mass2), l1(length1), l2(length2), m2(mass2), gravity(g);
    const Real upper = l1 * v[0], lower = l2 * v[1];
    const Real kinetic = (both * upper * upper + m2 * lower * lower) / Real(2) + m2 * upper * lower * cos(q[0] - q[1]);
    return kinetic + gravity * (both * l1 * cos(q[0]) + m2 * l2 * cos(q[1]));
  }
};

}  // namespace noether

#pragma once
/// A fixed angle of three particles.

#include "constraints/constraint.hpp"
#include "constraints/constraint_group.hpp"
#include "engine/description.hpp"

#include <cmath>
#include <numbers>
#include <optional>

namespace noether {

/// The angle at the second of three particles stays as it is: the true angle, not a distance of the outer two.
///
///     g = cos(angle) - cos(theta),   cos(angle) = a . b / (|a| |b|),   a = x_1 - x_2, b = x_3 - x_2
///
/// At 0 and 180 degrees the gradient vanishes, and no force can keep the angle: `rigid_bar` is for particles in line.
struct Angle {
  std::optional<double> theta = {};  ///< as at the start unless given [rad]

  static constexpr std::size_t particles = 3;
  static constexpr bool keeps_momentum = true, keeps_angular_momentum = true;
  static constexpr auto describe() {
    return part<Angle>("angle", "keeps the angle at the second of three particles",
                       formula("cos(angle) = a . b / (|a| |b|) = cos(theta)"), source("Allen2017"),
                       field<&Angle::theta>("theta", "angle", "the angle; default: as at the start"));
  }

  /// @throws Error  for an angle outside 0 to 180 degrees, these two excluded
  void check() const {
    if (theta && !(*theta > 0 && *theta < std::numbers::pi)) {
      refuse_field("theta", *theta,
                   "is not an angle that forces can hold; an angle between 0 and 180 degrees is expected");
    }
  }
  Angle at_start(const Points<double, 3>& x) const {
    if (theta) return *this;
    const Vec3<double> a = x[0] - x[1], b = x[2] - x[1];
    return Angle{std::atan2(std::sqrt(norm2(cross(a, b))), dot(a, b))};
  }

  template <class Real> Real value(const Points<Real, 3>& x) const {
    using std::cos, std::sqrt;
    const Vec3<Real> a = x[0] - x[1], b = x[2] - x[1];
    return dot(a, b) / sqrt(norm2(a) * norm2(b)) - cos(Real(*theta));
  }
};

extern template class ConstraintsOf<Angle>;  // compiled once, in angle.cpp

}  // namespace noether

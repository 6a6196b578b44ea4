#pragma once
/// Particles in line on a rigid bar.

#include "constraints/constraint.hpp"
#include "constraints/distance.hpp"
#include "engine/description.hpp"

namespace noether {

/// The second of three particles stays where it is on the line between the other two.
///
///     g = x_2 - (1 - f) x_1 - f x_3
///
/// Distances and angles of particles in line have linearly dependent gradients; these do not.
/// @source CiccottiFerrarioRyckaert1982
struct OnBar {
  std::optional<double> fraction = {};  ///< f, of the way from the first to the third; as at the start unless given

  static constexpr std::size_t particles = 3;
  static constexpr bool keeps_momentum = true, keeps_angular_momentum = true;
  static constexpr auto describe() {
    return part<OnBar>("on_bar", "keeps the second of three particles in its place on the line of the others",
                       formula("x_2 = (1 - f) x_1 + f x_3"), source("CiccottiFerrarioRyckaert1982"),
                       field<&OnBar::fraction>("fraction", "1", "f; default: as at the start"));
  }
  OnBar at_start(const Points<double, 3>& x) const {
    if (fraction) return *this;
    const Vec3<double> bar = x[2] - x[0];
    return OnBar{dot(bar, Vec3<double>(x[1] - x[0])) / norm2(bar)};
  }
  template <class Real> std::array<Real, 3> value(const Points<Real, 3>& x) const {
    const Real f(*fraction);
    const Vec3<Real> g = (x[1] - x[0]) - (x[2] - x[0]) * f;
    return {g[0], g[1], g[2]};
  }
};

}  // namespace noether

#pragma once
/// A frame that is driven round: a field on SO(3) with a closed solution.

#include "engine/description.hpp"
#include "integrators/lie/linear_rotation.hpp"
#include "integrators/lie/rotations.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace noether {

/// Orientation of what precesses about a direction that turns itself, as a spin in a rotating field does (Rabi).
///
///     Y' = hat(a) Y,   a = (drive cos(frequency t), drive sin(frequency t), rate)
///
/// In axes that turn with the field a is constant, so Y = R_3(frequency t) exp(t hat(drive, 0, rate - frequency)).
/// @source Rabi1937
struct TurningFrame : RotationMatrix<3> {
  double drive = 1;      ///< [1/time]
  double rate = 0.5;     ///< [1/time]
  double frequency = 2;  ///< [1/time]

  static constexpr auto describe() {
    return part<TurningFrame>(
        "turning_frame", "a frame that precesses about a direction that turns, on the group of rotations",
        formula("Y' = hat(a) Y,  a = (drive cos(frequency t), drive sin(frequency t), rate)"), source("Rabi1937"),
        quantities("Y, row by row [1]"),
        field<&TurningFrame::drive>("drive", "1/time", "rate about the direction that turns"),
        field<&TurningFrame::rate>("rate", "1/time", "rate about the third axis"),
        field<&TurningFrame::frequency>("frequency", "1/time", "angular frequency of the direction"));
  }

  template <class Real> void rates(const Real& t, SmallMatrix<Real>& A) const {
    using std::cos, std::sin;
    const Real angle = Real(frequency) * t;
    A(0, 1) = -Real(rate);
    A(0, 2) = Real(drive) * sin(angle);
    A(1, 2) = -Real(drive) * cos(angle);
  }
  /// The solution that begins at the unit matrix.
  template <class Real> Mat3<Real> turned(const Real& t) const {
    const Real none(0);
    const Quaternion<Real> about = rotation_by<Real>(Vec3<Real>(none, none, Real(frequency) * t)),
                           within = rotation_by<Real>(
                               Vec3<Real>(Real(drive) * t, none, (Real(rate) - Real(frequency)) * t));
    return rotation_matrix<Real>(quaternion_product<Real>(about, within));
  }
  std::vector<double> exact(double t) const {
    const Mat3<double> y = turned<double>(t);
    std::vector<double> all;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) all.push_back(y(i, k));
    }
    return all;
  }
};

}  // namespace noether

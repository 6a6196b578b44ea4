#pragma once
/// A constraint the user wrote: all that is needed for programs and scenes.

#include "constraints/constraint.hpp"
#include "engine/description.hpp"

#include <array>
#include <cmath>

/// A bead on a wire that is bent to a cycloid, the cusps up, in the plane z = 0.
///     x = R (u + sin u),  y = R (1 - cos u),  -pi < u < pi
struct OnCycloid {
  double radius = 1;  ///< R, of the circle that rolls [length]

  static constexpr std::size_t particles = 1;
  static constexpr auto describe() {
    using namespace noether;
    return part<OnCycloid>("on_cycloid", "a bead on a wire that is bent to a cycloid",
                           formula("x = R (u + sin u), y = R (1 - cos u), z = 0"),
                           field<&OnCycloid::radius>("radius", "length"));
  }

  void check() const {
    if (!(radius > 0)) noether::refuse_field("radius", radius, "is not a valid radius; a length above 0 is expected");
  }

  template <class Real> std::array<Real, 2> value(const noether::Points<Real, 1>& x) const {
    using std::cos, std::sin;
    const Real X = x[0][0] / Real(radius);
    Real u = X / Real(2);  // Newton's method from here goes up to the root, and takes derivatives with it
    for (int k = 0; k < 8; ++k) u -= (u + sin(u) - X) / (Real(1) + cos(u));
    return {x[0][1] - Real(radius) * (Real(1) - cos(u)), x[0][2]};
  }
  double scale() const { return radius; }
};

#pragma once
/// How a point moves at a moment: what interpolation between two moments needs.

#include "numbers/types.hpp"

namespace noether {

/// Position, velocity and acceleration of a point.
template <class Real> struct Motion { Vec3<Real> x, v, a; };

/// The motion of one point as seen from another.
template <class Real> Motion<Real> operator-(const Motion<Real>& a, const Motion<Real>& b) {
  return {a.x - b.x, a.v - b.v, a.a - b.a};
}

}  // namespace noether

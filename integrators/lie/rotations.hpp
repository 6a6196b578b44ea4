#pragma once
/// Exponentials of rotations and of rigid motions.

#include "numbers/quaternion.hpp"
#include "numbers/small_angle.hpp"

#include <cmath>

namespace noether {

/// The rotation by |u| about u, as a unit quaternion.
/// @cost a root, a sine and a cosine
template <class Real> Quaternion<Real> rotation_by(const Vec3<Real>& u) {
  using std::sqrt;
  const Real angle = sqrt(norm2(u));
  if (!(angle > Real(0))) return quaternion<Real>(Real(1), u / Real(2));
  const SineCosine<Real> half = sine_cosine<Real>(angle / Real(2));
  return quaternion<Real>(half.cosine, u * (half.sine / angle));
}

/// int_0^1 exp(s u) v ds: how far a rigid motion of angular velocity u and velocity v, both in its own axes, goes in a
/// unit of time.
///
///     v + (1 - cos a)/a^2 u x v + (a - sin a)/a^3 u x (u x v),   a = |u|
template <class Real> Vec3<Real> way_of_motion(const Vec3<Real>& u, const Vec3<Real>& v) {
  using std::sqrt;
  const Real square = norm2(u), angle = sqrt(square);
  Real first, second;
  if (square < Real(0.25)) {  // a - sin a would lose digits
    Real term(1), sum_of_first(0), sum_of_second(0);
    for (int k = 1; k <= 24; ++k) {
      term /= Real(2 * k);
      sum_of_first += term;
      term /= Real(2 * k + 1);
      sum_of_second += term;
      term *= -square;
    }
    first = sum_of_first;
    second = sum_of_second;
  } else {
    const SineCosine<Real> half = sine_cosine<Real>(angle / Real(2));
    first = Real(2) * half.sine * half.sine / square;
    second = (angle - Real(2) * half.sine * half.cosine) / (square * angle);
  }
  const Vec3<Real> once = cross<Real>(u, v), twice = cross<Real>(u, once);
  return v + first * once + second * twice;
}

}  // namespace noether

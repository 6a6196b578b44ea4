#pragma once
/// Unit quaternions as rotations: q = (w, x, y, z) turns a vector of the body into one of space.

#include "numbers/types.hpp"

namespace noether {

/// (w, x, y, z); as a rotation by the angle a about the unit vector n: (cos a/2, n sin a/2).
template <class Real> using Quaternion = Eigen::Matrix<Real, 4, 1>;

/// The quaternion of scalar part `w` and vector part `v`.
template <class Real> Quaternion<Real> quaternion(const Real& w, const Vec3<Real>& v) {
  return Quaternion<Real>(w, v[0], v[1], v[2]);
}
template <class Real> Vec3<Real> vector_part(const Quaternion<Real>& q) { return Vec3<Real>(q[1], q[2], q[3]); }

/// The product: the rotation b, then a.
template <class Real> Quaternion<Real> quaternion_product(const Quaternion<Real>& a, const Quaternion<Real>& b) {
  return Quaternion<Real>(
      a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
      a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]);
}
/// The way back of a rotation.
template <class Real> Quaternion<Real> conjugate(const Quaternion<Real>& q) {
  return Quaternion<Real>(q[0], -q[1], -q[2], -q[3]);
}
/// |q|^2, summed from w to z.
template <class Real> Real squared_length(const Quaternion<Real>& q) {
  return q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
}
/// |q|^2 - 1: of a unit quaternion its rounding.
template <class Real> Real norm_defect(const Quaternion<Real>& q) { return squared_length(q) - Real(1); }
/// q (3 - |q|^2)/2: of unit length to the square of its error, without a root.
template <class Real> Quaternion<Real> renormalized(const Quaternion<Real>& q) {
  const Real factor = Real(1) - norm_defect(q) / Real(2);
  return Quaternion<Real>(q[0] * factor, q[1] * factor, q[2] * factor, q[3] * factor);
}

/// The rotation as a matrix, column k the body's axis k in space: x_space = R x_body.
template <class Real> Mat3<Real> rotation_matrix(const Quaternion<Real>& q) {
  const Real &w = q[0], &x = q[1], &y = q[2], &z = q[3];
  const Real two(2);
  Mat3<Real> r;
  r << w * w + x * x - y * y - z * z, two * (x * y - w * z), two * (x * z + w * y), two * (x * y + w * z),
      w * w - x * x + y * y - z * z, two * (y * z - w * x), two * (x * z - w * y), two * (y * z + w * x),
      w * w - x * x - y * y + z * z;
  return r;
}
/// A vector of the body in space.
template <class Real> Vec3<Real> to_space(const Mat3<Real>& r, const Vec3<Real>& v) {
  return Vec3<Real>(r(0, 0) * v[0] + r(0, 1) * v[1] + r(0, 2) * v[2], r(1, 0) * v[0] + r(1, 1) * v[1] + r(1, 2) * v[2],
                    r(2, 0) * v[0] + r(2, 1) * v[1] + r(2, 2) * v[2]);
}
/// A vector of space in the body.
template <class Real> Vec3<Real> to_body(const Mat3<Real>& r, const Vec3<Real>& v) {
  return Vec3<Real>(r(0, 0) * v[0] + r(1, 0) * v[1] + r(2, 0) * v[2], r(0, 1) * v[0] + r(1, 1) * v[1] + r(2, 1) * v[2],
                    r(0, 2) * v[0] + r(1, 2) * v[1] + r(2, 2) * v[2]);
}

}  // namespace noether

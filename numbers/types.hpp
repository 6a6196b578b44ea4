#pragma once
/// Indices and small vectors: the words every other file is written in.

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>

#ifdef __FAST_MATH__
#error "noether keeps the same bits for every build: compile without fast math"
#endif

namespace noether {

using Index = std::ptrdiff_t;

template <class Real> using Vec3 = Eigen::Matrix<Real, 3, 1>;

template <class Real> using Mat3 = Eigen::Matrix<Real, 3, 3>;

/// Scalar product summed from x to z, so that its bits do not depend on how a compiler vectorises Eigen.
///     a . b = a_x b_x + a_y b_y + a_z b_z
/// @throws never
template <class A, class B>
inline auto dot(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) -> typename A::Scalar {
  return a.derived().coeff(0) * b.derived().coeff(0) + a.derived().coeff(1) * b.derived().coeff(1) +
         a.derived().coeff(2) * b.derived().coeff(2);
}

/// Square of the Euclidean length, summed from x to z.
/// @throws never
template <class A> inline auto norm2(const Eigen::MatrixBase<A>& a) -> typename A::Scalar { return dot(a, a); }

/// Vector product.
/// @throws never
template <class Real> inline Vec3<Real> cross(const Vec3<Real>& a, const Vec3<Real>& b) {
  return Vec3<Real>(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
}

}  // namespace noether

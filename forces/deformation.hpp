#pragma once
/// Deformations of an element: the derivative F of where it is by where it was at rest.

#include "forces/materials.hpp"
#include "numbers/types.hpp"

#include <array>
#include <cstddef>

namespace noether::detail {

/// A deformation F, row by row, from the edges of a tetrahedron and their inverse at rest.
template <class Real> struct Deformation {
  std::array<Vec3<Real>, 3> row;

  /// F^T F.
  Symmetric<Real> square() const {
    const auto sum = [&](int i, int j) {
      return row[0][i] * row[0][j] + row[1][i] * row[1][j] + row[2][i] * row[2][j];
    };
    return {sum(0, 0), sum(1, 1), sum(2, 2), sum(0, 1), sum(0, 2), sum(1, 2)};
  }
  Real determinant() const { return dot(row[0], cross(row[1], row[2])); }
  /// F S.
  Deformation times(const Symmetric<Real>& s) const {
    Deformation product;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3<Real>& f = row[i];
      product.row[i] = Vec3<Real>(f[0] * s.xx + f[1] * s.xy + f[2] * s.xz, f[0] * s.xy + f[1] * s.yy + f[2] * s.yz,
                                  f[0] * s.xz + f[1] * s.yz + f[2] * s.zz);
    }
    return product;
  }
};

/// F^T G + G^T F: the change of the square where F changes by G, both from the middle.
template <class Real> Symmetric<Real> change_of_square(const Deformation<Real>& f, const Deformation<Real>& g) {
  const auto sum = [&](int i, int j) {
    Real total(0);
    for (std::size_t r = 0; r < 3; ++r) total += f.row[r][i] * g.row[r][j] + g.row[r][i] * f.row[r][j];
    return total;
  };
  return {sum(0, 0), sum(1, 1), sum(2, 2), sum(0, 1), sum(0, 2), sum(1, 2)};
}

}  // namespace noether::detail

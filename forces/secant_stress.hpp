#pragma once
/// Stresses between two deformations, which do the work of the energy, and how they change with the second one.

#include "forces/deformation.hpp"
#include "forces/materials.hpp"
#include "forces/secant.hpp"
#include "numbers/dual.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace noether::detail {

/// A tetrahedron between two states: F before, in the middle and after; C before and after, and C1 - C0, which is
/// rounded less than their difference.
template <class Real> struct DeformationStep {
  Deformation<Real> first, middle, last;
  Symmetric<Real> before, after, change;
};

template <class Real> const Real& plain_value(const Real& x) { return x; }
template <class Real, std::size_t n> const Real& plain_value(const Dual<Real, n>& x) { return x.value; }

/// The stress S' of `Hyperelastic` from C0 to C1. @param change  C1 - C0, as in `DeformationStep`
template <class Number, class Real, class M>
Symmetric<Number> secant_stress(const M& material, const Symmetric<Real>& c0, const Symmetric<Number>& c1,
                                const Symmetric<Number>& change) {
  using std::abs, std::sqrt;
  const Number half(0.5), two(2);
  const Symmetric<Number> start = {Number(c0.xx), Number(c0.yy), Number(c0.zz),
                                   Number(c0.xy), Number(c0.xz), Number(c0.yz)};
  const Symmetric<Number> mean = half * (start + c1), stress = stress_of<Number>(material, mean);
  const Number size2 = contract(mean, mean), step2 = contract(change, change);
  if (is_shortest(plain_value(step2), plain_value(size2))) return stress;
  const Real before = material.energy(c0);
  const Number after = material.energy(c1), missing = after - Number(before) - half * contract(stress, change);
  const Real strength = sqrt(plain_value(contract(stress, stress)) * plain_value(size2));
  const Real scale = abs(before) + abs(plain_value(after)) + strength;
  if (is_rounding(plain_value(missing), scale)) return stress;
  return stress + two * missing / step2 * change;
}

/// dP/dF1 of P = F' S': how row i, column A changes with row j, column B of F1, at [A][B](i, j).
template <class Real> using StressSlopes = std::array<std::array<Mat3<Real>, 3>, 3>;

/// Where the element of row a and column b of a symmetric tensor stands.
inline constexpr std::array<std::array<std::size_t, 3>, 3> place_of_symmetric = {{{0, 3, 4}, {3, 1, 5}, {4, 5, 2}}};

template <class Real, class M> StressSlopes<Real> secant_slopes(const M& material, const DeformationStep<Real>& step) {
  using D = Dual<Real, 6>;
  const auto varied = [](const Symmetric<Real>& c) {
    return Symmetric<D>{D::variable(c.xx, 0), D::variable(c.yy, 1), D::variable(c.zz, 2),
                        D::variable(c.xy, 3), D::variable(c.xz, 4), D::variable(c.yz, 5)};
  };
  const Symmetric<D> s = secant_stress<D>(material, step.before, varied(step.after), varied(step.change));
  const std::array<const D*, 6> stress = {&s.xx, &s.yy, &s.zz, &s.xy, &s.xz, &s.yz};
  StressSlopes<Real> slopes;
  for (std::size_t b = 0; b < 3; ++b) {
    // Of C1, dF1 in row j and column b changes the elements of row and column b by row j of F1.
    std::array<Vec3<Real>, 6> by;  // stresses, with each row j
    for (std::size_t k = 0; k < 6; ++k) {
      by[k] = Vec3<Real>::Zero();
      for (std::size_t n = 0; n < 3; ++n) {
        const Real& slope = stress[k]->slope[place_of_symmetric[b][n]];
        const Real weight = b == n ? slope + slope : slope;
        for (std::size_t j = 0; j < 3; ++j)
          by[k][static_cast<Index>(j)] += weight * step.last.row[j][static_cast<Index>(n)];
      }
    }
    for (std::size_t a = 0; a < 3; ++a) {
      Mat3<Real>& slope = slopes[a][b];
      slope = Mat3<Real>::Identity() * (stress[place_of_symmetric[a][b]]->value / Real(2));
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
          slope.row(static_cast<Index>(i)) +=
              step.middle.row[i][static_cast<Index>(c)] * by[place_of_symmetric[c][a]].transpose();
        }
      }
    }
  }
  return slopes;
}

/// sum over B of the slopes times g_B, at [A](i, j).
template <class Real> std::array<Mat3<Real>, 3> slopes_along(const StressSlopes<Real>& slopes, const Vec3<Real>& g) {
  std::array<Mat3<Real>, 3> sum;
  for (std::size_t a = 0; a < 3; ++a) sum[a] = g[0] * slopes[a][0] + g[1] * slopes[a][1] + g[2] * slopes[a][2];
  return sum;
}

}  // namespace noether::detail

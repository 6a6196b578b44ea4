#pragma once
/// Jacobi's elliptic functions and elliptic integrals over any number type, as free bodies that turn need them.
///
/// The parameter is m = k^2, given by its complement m1 = 1 - m > 0 as well where it matters: beside m = 1 that is what
/// must be known to all digits. The functions of dual numbers and K have derivatives in both arguments; integrals of
/// the third kind have none that count.

#include "numbers/dual.hpp"
#include "numbers/real.hpp"
#include "numbers/small_angle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace noether {

namespace detail {

/// Whether a number carries derivatives, and what its values are made of.
template <class Real> struct DualOf {
  static constexpr bool is = false;
  using Limits = std::numeric_limits<Real>;
};
template <class Real, std::size_t n> struct DualOf<Dual<Real, n>> {
  static constexpr bool is = true;
  using Limits = typename DualOf<Real>::Limits;
};
template <class Real> using LimitsOf = typename DualOf<Real>::Limits;

}  // namespace detail

/// sn u, cn u, dn u.
template <class Real> struct JacobiFunctions { Real sn, cn, dn; };

/// The Jacobi elliptic functions at `u`, for m1 = 1 - m in [0, 1], by Landen's transformation downwards.
/// @cost a sine, a cosine, and a root and four divisions for each of up to seven rounds (nine in Quad)
/// @source Bulirsch1965
template <class Real> JacobiFunctions<Real> jacobi_functions(const Real& u, const Real& m1) {
  using std::cosh, std::fabs, std::sqrt, std::tanh;
  if (m1 == Real(0)) {
    const Real sech = Real(1) / cosh(u);
    return {tanh(u), sech, sech};
  }
  if (fabs(u) < sqrt(std::numeric_limits<Real>::min())) return {u, Real(1), Real(1)};  // 1/u^2 would overflow
  static constexpr int most = 16;
  // The means agree to half the digits: the next round would make them agree to all.
  const Real near_enough = sqrt(std::numeric_limits<Real>::epsilon()) / Real(16);
  std::array<Real, most> mean, root;
  Real a(1), square = m1, dn(1), c;
  int last = 0;
  for (int k = 0;; ++k) {
    last = k;
    mean[static_cast<std::size_t>(k)] = a;
    const Real b = sqrt(square);
    root[static_cast<std::size_t>(k)] = b;
    c = (a + b) / Real(2);
    if (fabs(a - b) <= near_enough * a || k + 1 == most) break;
    square = b * a;
    a = c;
  }
  auto [sn, cn] = sine_cosine<Real>(c * u);
  if (sn == Real(0)) return {sn, cn, dn};
  a = cn / sn;
  c *= a;
  for (int k = last; k >= 0; --k) {
    const Real& b = mean[static_cast<std::size_t>(k)];
    a *= c;
    c *= dn;
    dn = (root[static_cast<std::size_t>(k)] + a) / (b + a);
    a = c / b;
  }
  a = Real(1) / sqrt(c * c + Real(1));
  sn = sn < Real(0) ? Real(-a) : a;
  return {sn, c * sn, dn};
}

/// The complete integral K of the first kind, for m1 = 1 - m in (0, 1], by the arithmetic-geometric mean.
template <class Real> Real complete_elliptic(const Real& m1) {
  using std::atan2, std::fabs, std::sqrt;
  Real a(1), b = sqrt(m1);
  const Real near_enough = Real(sqrt(detail::LimitsOf<Real>::epsilon())) / Real(16);
  for (int k = 0; k < 16 && fabs(a - b) > near_enough * a; ++k) {
    const Real mean = (a + b) / Real(2);
    b = sqrt(a * b);
    a = mean;
  }
  return atan2(Real(1), Real(0)) * Real(2) / (a + b);  // pi/2 over the mean
}

namespace detail {

/// Carlson's R_C(1, 1 + e) = atan(sqrt e)/sqrt e for e >= 0.
template <class Real> Real carlson_rc(const Real& e) {
  using std::atan2, std::sqrt;
  if (e < Real(1e-5)) {
    Real sum(0);
    const int terms = LimitsOf<Real>::digits > 60 ? 8 : 4;
    for (int k = terms - 1; k >= 0; --k) sum = Real(1) / Real(2 * k + 1) - e * sum;
    return sum;
  }
  const Real root = sqrt(e);
  return atan2(root, Real(1)) / root;
}

}  // namespace detail

/// Carlson's R_J(x, y, 1, p) for 0 <= x, y <= 1 <= p, of which at most one of x and y is 0.
/// @cost three roots and an arc tangent for each of some five rounds (ten in Quad)
/// @source Carlson1995
template <class Real> Real carlson_rj(Real x, Real y, Real p) {
  using std::fabs, std::max, std::sqrt;
  Real z(1);
  const Real first = (x + y + z + Real(2) * p) / Real(5);
  Real delta = (p - x) * (p - y) * (p - z);
  const Real dx = first - x, dy = first - y, dz = first - z;
  // Terms up to degree 7: what is left out is of degree 8, below a quarter of the rounding unit.
  using std::pow;
  static const Real smallest = pow(Real(detail::LimitsOf<Real>::epsilon()) / Real(4), Real(1) / Real(8));
  Real reach = max(max(fabs(dx), fabs(dy)), max(fabs(dz), fabs(first - p))) / smallest;
  Real a = first, scale(1), sum(0);
  for (int k = 0; k < 64 && reach >= a; ++k) {
    const Real rx = sqrt(x), ry = sqrt(y), rz = sqrt(z), rp = sqrt(p);
    const Real lambda = rx * ry + rx * rz + ry * rz;
    const Real d = (rp + rx) * (rp + ry) * (rp + rz);
    const Real e = delta / (d * d);
    sum += scale / d * detail::carlson_rc(e);
    a = (a + lambda) / Real(4);
    x = (x + lambda) / Real(4);
    y = (y + lambda) / Real(4);
    z = (z + lambda) / Real(4);
    p = (p + lambda) / Real(4);
    delta /= Real(64);
    scale /= Real(4);
    reach /= Real(4);
  }
  const Real X = dx * scale / a, Y = dy * scale / a, Z = dz * scale / a, P = -(X + Y + Z) / Real(2);
  const Real E2 = X * Y + X * Z + Y * Z - Real(3) * P * P;
  const Real E3 = X * Y * Z + Real(2) * E2 * P + Real(4) * P * P * P;
  const Real E4 = (Real(2) * X * Y * Z + E2 * P + Real(3) * P * P * P) * P, E5 = X * Y * Z * P * P;
  const Real series = Real(1) - Real(3) * E2 / Real(14) + E3 / Real(6) + Real(9) * E2 * E2 / Real(88) -
                      Real(3) * E4 / Real(22) - Real(9) * E2 * E3 / Real(52) + Real(3) * E5 / Real(26) -
                      E2 * E2 * E2 / Real(16) + Real(3) * E3 * E3 / Real(40) + Real(3) * E2 * E4 / Real(20) +
                      Real(45) * E2 * E2 * E3 / Real(272) - Real(9) * (E3 * E4 + E2 * E5) / Real(68);
  return scale * series / (a * sqrt(a)) + Real(6) * sum;
}

/// The functions and their derivatives in u and m1, for |u| <= K. With u kept, the amplitude changes with m1 by dn/2
/// times int_0^u sn^2/dn^2 dw = sn^3/3 R_D(cn^2, 1, dn^2), all of whose terms have one sign.
/// @source Carlson1995
template <class Value, std::size_t n>
JacobiFunctions<Dual<Value, n>> jacobi_functions(const Dual<Value, n>& u, const Dual<Value, n>& m1) {
  const JacobiFunctions<Value> at = jacobi_functions<Value>(u.value, m1.value);
  const Value dn2 = at.dn * at.dn, over = Value(1) / dn2;
  const Value by_m1 =
      at.sn * at.sn * at.sn / Value(6) * carlson_rj<Value>(at.cn * at.cn * over, over, Value(1)) * over / at.dn;
  JacobiFunctions<Dual<Value, n>> all{at.sn, at.cn, at.dn};
  for (std::size_t k = 0; k < n; ++k) {
    const Value amplitude = at.dn * (u.slope[k] + by_m1 * m1.slope[k]);
    all.sn.slope[k] = at.cn * amplitude;
    all.cn.slope[k] = -at.sn * amplitude;
    all.dn.slope[k] =
        (at.cn * all.cn.slope[k] + m1.value * at.sn * all.sn.slope[k] + m1.slope[k] * at.sn * at.sn / Value(2)) / at.dn;
  }
  return all;
}

/// The integral of the third kind, int_0^u dw/(1 - n sn^2 w) for n <= 0 and |u| <= K, from the functions at u.
/// @source Carlson1995
template <class Real> Real third_elliptic(const Real& u, const Real& n, const JacobiFunctions<Real>& at) {
  if (n == Real(0)) return u;
  const Real s2 = at.sn * at.sn;
  return u + n / Real(3) * at.sn * s2 * carlson_rj<Real>(at.cn * at.cn, at.dn * at.dn, Real(1) - n * s2);
}

/// The same over a quarter period, int_0^K, for m1 = 1 - m in (0, 1].
template <class Real> Real complete_third_elliptic(const Real& quarter, const Real& n, const Real& m1) {
  return n == Real(0) ? quarter : quarter + n / Real(3) * carlson_rj<Real>(Real(0), m1, Real(1) - n);
}

}  // namespace noether

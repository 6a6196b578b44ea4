#pragma once
/// The universal functions of the two-body problem: one set for ellipse, parabola and hyperbola.

#include "numbers/real.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace noether::detail {

// Number types without limits of their own (dual numbers, series) are taken to hold doubles.
template <class Real>
inline constexpr int kepler_digits = std::numeric_limits<Real>::digits > 0 ? std::numeric_limits<Real>::digits : 53;

template <class Real> constexpr Real kepler_constant(Quad x) {
  if constexpr (std::is_same_v<Real, Quad>) {
    return x;
  } else {
    return Real(static_cast<double>(x));
  }
}

constexpr Quad power_of_two(int n) {
  Quad p(1);
  for (int i = 0; i < (n < 0 ? -n : n); ++i) p *= n < 0 ? Quad(0.5) : Quad(2);
  return p;
}

/// n! c_n(z) = sum of (-1)^k n! / (2 k + n)! z^k, terms enough for |z| up to 1.
///
/// A constant that is always rounded the same way would make the energy of a long run drift. So the first coefficient
/// is exactly 1, and `low` is what rounding took from the next two, added where the sum is still small.
template <class Real> struct StumpffSeries {
  static constexpr std::size_t terms = kepler_digits<Real> <= 53 ? 10 : kepler_digits<Real> <= 113 ? 17 : 34;
  std::array<Real, terms> high;
  std::array<Real, 3> low;

  explicit constexpr StumpffSeries(int n) : high{}, low{Real(0), Real(0), Real(0)} {
    Quad term(1);
    for (std::size_t k = 0; k < terms; ++k) {
      high[k] = kepler_constant<Real>(term);
      if constexpr (std::is_same_v<Real, double>) {
        if (k < low.size()) low[k] = static_cast<double>(term - Quad(high[k]));
      }
      const int j = 2 * static_cast<int>(k) + n;
      term /= -Quad(j + 1) * Quad(j + 2);
    }
  }

  Real operator()(const Real& z) const {
    Real sum = high[terms - 1];
    for (std::size_t k = terms - 2; k >= 3; --k) sum = high[k] + z * sum;
    return Real(1) + z * (high[1] + (low[1] + z * (high[2] + (low[2] + z * sum))));
  }
};

template <class Real> inline constexpr StumpffSeries<Real> stumpff_2(2);
template <class Real> inline constexpr StumpffSeries<Real> stumpff_3(3);
template <class Real> inline constexpr StumpffSeries<Real> stumpff_4(4);
template <class Real> inline constexpr StumpffSeries<Real> stumpff_5(5);

/// G_n(s) = s^n c_n(beta s^2): cosine and sine of the universal variable and their integrals.
template <class Real> struct UniversalFunctions {
  Real g0, g1, g2, g3;

  UniversalFunctions(const Real& beta, const Real& s) {
    using std::abs;
    constexpr int most_halvings = 15;  // beyond 2^15 radians the hyperbolic functions overflow in any type
    int halvings = 0;
    Real part = s, z = beta * s * s;
    for (; !(abs(z) <= Real(1)) && halvings < most_halvings; ++halvings) {
      part *= Real(0.5);
      z *= Real(0.25);
    }
    const Real square = part * part;
    g2 = square * stumpff_2<Real>(z) / Real(2);
    g3 = part * square * stumpff_3<Real>(z) / Real(6);
    g1 = part - beta * g3;
    g0 = Real(1) - beta * g2;
    for (; halvings > 0; --halvings) {
      g3 = Real(2) * (g3 + g1 * g2);
      g2 = Real(2) * g1 * g1;
      g1 = Real(2) * g0 * g1;
      g0 = Real(1) - beta * g2;
    }
  }

  /// The same functions at s + d for small d, by the addition theorem. G_n(d) themselves: c1, c2, c3.
  void shift(const Real& beta, const Real& d, const Real& c1, const Real& c2, const Real& c3) {
    const Real g1_old = g1;
    g3 += d * g2 + (g1 * c2 + g0 * c3);
    g2 += g1 * c1 + g0 * c2;
    g1 += g0 * c1 - beta * g1 * c2;
    g0 -= beta * (g1_old * c1 + g0 * c2);
  }
};

}  // namespace noether::detail

#pragma once
/// Sums and products of doubles with what their rounding leaves out.

#include "engine/real.hpp"

namespace noether {

/// A number as the sum of two doubles, the second below the rounding of the first: about 106 bits.
///
/// Products of doubles are exact, sums right to 2^-104 of the larger term; numbers beyond 2^996 overflow.
/// @cost 17 operations of doubles for a product, 11 for a sum: a tenth of Quad
/// @source Dekker1971
struct DoubleDouble {
  double high = 0, low = 0;

  constexpr DoubleDouble() = default;
  constexpr DoubleDouble(double x) : high(x) {}  // NOLINT: exact
  constexpr DoubleDouble(double high_part, double low_part) : high(high_part), low(low_part) {}
  /// The nearest one. @cost two conversions and a difference of Quad
  explicit DoubleDouble(const Quad& x)
      : high(static_cast<double>(x)), low(static_cast<double>(x - Quad(static_cast<double>(x)))) {}
  explicit operator Quad() const { return Quad(high) + Quad(low); }
  explicit operator double() const { return high; }

  /// a + b and its rounding error, in any order of sizes.
  static constexpr DoubleDouble sum(double a, double b) {
    const double s = a + b, of_b = s - a;
    return {s, (a - (s - of_b)) + (b - of_b)};
  }
  /// The same where a is the larger one, or 0.
  static constexpr DoubleDouble ordered_sum(double a, double b) {
    const double s = a + b;
    return {s, b - (s - a)};
  }
  /// a b, exactly.
  static constexpr DoubleDouble product(double a, double b) {
    constexpr double half = 134217729.0;  // 2^27 + 1: splits 53 bits in two
    const double ta = half * a, a1 = ta - (ta - a), a2 = a - a1;
    const double tb = half * b, b1 = tb - (tb - b), b2 = b - b1;
    const double p = a * b;
    return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
  }

  constexpr DoubleDouble operator-() const { return {-high, -low}; }
  friend constexpr DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble s = sum(a.high, b.high);
    return ordered_sum(s.high, s.low + (a.low + b.low));
  }
  friend constexpr DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }
  friend constexpr DoubleDouble operator*(double a, const DoubleDouble& b) {
    const DoubleDouble p = product(a, b.high);
    return ordered_sum(p.high, p.low + a * b.low);
  }
  constexpr DoubleDouble& operator+=(const DoubleDouble& b) { return *this = *this + b; }
};

}  // namespace noether

#pragma once
/// Sums and products of doubles with what their rounding leaves out.

#include "numbers/real.hpp"

#include <bit>
#include <cstdint>

namespace noether {

/// A number as the sum of two doubles, the second below the rounding of the first: about 106 bits.
///
/// Products of doubles are exact, sums right to 2^-104 of the larger term.
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
    const double a1 = upper_half(a), a2 = a - a1, b1 = upper_half(b), b2 = b - b1, p = a * b;
    return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
  }
  /// The nearest number of 26 bits, what is left has 26 too; no size overflows on the way.
  static constexpr double upper_half(double a) {
    return std::bit_cast<double>((std::bit_cast<std::uint64_t>(a) + (1U << 26U)) & ~std::uint64_t{(1U << 27U) - 1});
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

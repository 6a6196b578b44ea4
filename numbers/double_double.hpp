#pragma once
/// Sums and products of doubles with what their rounding leaves out.

#include "numbers/real.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace noether {

/// A number as the sum of two doubles, the second below the rounding of the first: about 106 bits.
///
/// Products of doubles are exact; sums are right to 2^-104 of the larger term, products, quotients and roots to 2^-101
/// of themselves. There is no rounding to nearest: a low word tells what it can.
/// @cost 17 operations of doubles for a product of doubles, 11 for a sum, some 25 for a product, 60 for a quotient or a
///       root: a tenth of Quad
/// @source Dekker1971
struct DoubleDouble {
  double high = 0, low = 0;

  constexpr DoubleDouble() = default;
  constexpr DoubleDouble(double x) : high(x) {}  // NOLINT: exact
  constexpr DoubleDouble(double high_part, double low_part) : high(high_part), low(low_part) {}
  /// The nearest one. @cost two conversions and a difference of Quad
  explicit constexpr DoubleDouble(const Quad& x)
      : high(static_cast<double>(x)), low(static_cast<double>(x - Quad(static_cast<double>(x)))) {}
  explicit constexpr operator Quad() const { return Quad(high) + Quad(low); }
  explicit constexpr operator double() const { return high; }

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
  friend constexpr DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble p = product(a.high, b.high);
    return ordered_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
  }
  friend constexpr DoubleDouble operator*(double a, const DoubleDouble& b) {
    const DoubleDouble p = product(a, b.high);
    return ordered_sum(p.high, p.low + a * b.low);
  }
  friend constexpr DoubleDouble operator*(const DoubleDouble& a, double b) { return b * a; }
  /// Division of the high words, corrected by what it leaves; as doubles have it where that is 0 or not finite.
  friend constexpr DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
    const double q = a.high / b.high;
    const DoubleDouble left = a - q * b;
    const double more = left.high / b.high;
    return more - more == 0 ? ordered_sum(q, more) : DoubleDouble(q);
  }
  constexpr DoubleDouble& operator+=(const DoubleDouble& b) { return *this = *this + b; }
  constexpr DoubleDouble& operator-=(const DoubleDouble& b) { return *this = *this - b; }
  constexpr DoubleDouble& operator*=(const DoubleDouble& b) { return *this = *this * b; }
  constexpr DoubleDouble& operator/=(const DoubleDouble& b) { return *this = *this / b; }

  friend constexpr bool operator==(const DoubleDouble& a, const DoubleDouble& b) {
    return a.high == b.high && a.low == b.low;
  }
  friend constexpr bool operator!=(const DoubleDouble& a, const DoubleDouble& b) { return !(a == b); }
  friend constexpr bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
    return a.high < b.high || (a.high == b.high && a.low < b.low);
  }
  friend constexpr bool operator>(const DoubleDouble& a, const DoubleDouble& b) { return b < a; }
  friend constexpr bool operator<=(const DoubleDouble& a, const DoubleDouble& b) { return a < b || a == b; }
  friend constexpr bool operator>=(const DoubleDouble& a, const DoubleDouble& b) { return b < a || a == b; }
};

constexpr DoubleDouble abs(const DoubleDouble& x) { return x.high < 0 || (x.high == 0 && x.low < 0) ? -x : x; }
/// The root of the high word, and a step of Newton's from there; as doubles have it of 0 and of what is not finite.
inline DoubleDouble sqrt(const DoubleDouble& x) {
  const double root = std::sqrt(x.high);
  const double more = (x - DoubleDouble::product(root, root)).high / (2 * root);
  return more - more == 0 ? DoubleDouble::ordered_sum(root, more) : DoubleDouble(root);
}
/// The largest whole number that is no larger.
inline DoubleDouble floor(const DoubleDouble& x) {
  const double high = std::floor(x.high);
  return high == x.high ? DoubleDouble::ordered_sum(high, std::floor(x.low)) : DoubleDouble(high);
}
/// log(1 + x), by way of Quad.
inline DoubleDouble log1p(const DoubleDouble& x) { return DoubleDouble(log1p(Quad(x))); }
inline bool isfinite(const DoubleDouble& x) { return std::isfinite(x.high); }

}  // namespace noether

namespace std {
/// Digits that results can be relied on, not those that single numbers may have.
template <> class numeric_limits<noether::DoubleDouble> : public numeric_limits<double> {
 public:
  static constexpr bool is_iec559 = false;
  static constexpr int digits = 104, digits10 = 31, max_digits10 = 33;
  static constexpr noether::DoubleDouble epsilon() { return {0x1p-103}; }
  static constexpr noether::DoubleDouble max() { return {numeric_limits<double>::max()}; }
  static constexpr noether::DoubleDouble lowest() { return {numeric_limits<double>::lowest()}; }
  static constexpr noether::DoubleDouble infinity() { return {numeric_limits<double>::infinity()}; }
  static constexpr noether::DoubleDouble quiet_NaN() { return {numeric_limits<double>::quiet_NaN()}; }
};
}  // namespace std

namespace Eigen {
template <> struct NumTraits<noether::DoubleDouble> : GenericNumTraits<noether::DoubleDouble> {
  using Real = noether::DoubleDouble;
  using NonInteger = noether::DoubleDouble;
  using Literal = double;
  using Nested = noether::DoubleDouble;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 2,
    AddCost = 11,
    MulCost = 25
  };
};
}  // namespace Eigen

#pragma once
/// The number types that state, direct gravity, Kepler arcs and compositions are written over: `double` and `Quad`.

#include "numbers/select.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>

namespace noether {

#if defined(__SIZEOF_FLOAT128__) && !(defined(__LDBL_MANT_DIG__) && __LDBL_MANT_DIG__ == 113)
using Binary128 = __float128;
#else
using Binary128 = long double;
static_assert(std::numeric_limits<long double>::digits == 113, "noether needs a 113-bit number type");
#endif

/// IEEE binary128, 113 bits of significand (about 34 decimal digits).
///
/// A plain value: every operation is the compiler's, correctly rounded, and may run at compile time. Mixed
/// expressions with built-in numbers widen them exactly.
/// @throws never
/// @cost about 30 to 60 times a double operation
struct Quad {
  Binary128 value = 0;

  constexpr Quad() = default;
  template <class T>
    requires std::is_arithmetic_v<T>
  constexpr Quad(T x) : value(static_cast<Binary128>(x)) {}  // NOLINT: widening is exact
  static constexpr Quad from(Binary128 x) {
    Quad q;
    q.value = x;
    return q;
  }

  template <class T>
    requires std::is_arithmetic_v<T>
  constexpr explicit operator T() const { return static_cast<T>(value); }

  constexpr Quad operator-() const { return from(-value); }
  constexpr Quad operator+() const { return *this; }
  constexpr Quad& operator+=(Quad b) { return value += b.value, *this; }
  constexpr Quad& operator-=(Quad b) { return value -= b.value, *this; }
  constexpr Quad& operator*=(Quad b) { return value *= b.value, *this; }
  constexpr Quad& operator/=(Quad b) { return value /= b.value, *this; }
  friend constexpr Quad operator+(Quad a, Quad b) { return from(a.value + b.value); }
  friend constexpr Quad operator-(Quad a, Quad b) { return from(a.value - b.value); }
  friend constexpr Quad operator*(Quad a, Quad b) { return from(a.value * b.value); }
  friend constexpr Quad operator/(Quad a, Quad b) { return from(a.value / b.value); }
  friend constexpr bool operator==(Quad a, Quad b) { return a.value == b.value; }
  friend constexpr bool operator!=(Quad a, Quad b) { return a.value != b.value; }
  friend constexpr bool operator<(Quad a, Quad b) { return a.value < b.value; }
  friend constexpr bool operator>(Quad a, Quad b) { return a.value > b.value; }
  friend constexpr bool operator<=(Quad a, Quad b) { return a.value <= b.value; }
  friend constexpr bool operator>=(Quad a, Quad b) { return a.value >= b.value; }
};

Quad sqrt(Quad x);
Quad cbrt(Quad x);
Quad sin(Quad x);
Quad cos(Quad x);
Quad tan(Quad x);
Quad atan2(Quad y, Quad x);
Quad acos(Quad x);
Quad sinh(Quad x);
Quad cosh(Quad x);
Quad asinh(Quad x);
Quad acosh(Quad x);
Quad exp(Quad x);
Quad expm1(Quad x);
Quad log(Quad x);
Quad log1p(Quad x);
Quad pow(Quad x, Quad y);
Quad asin(Quad x);
Quad atan(Quad x);
Quad tanh(Quad x);
Quad atanh(Quad x);
Quad erf(Quad x);
Quad erfc(Quad x);
Quad ceil(Quad x);
Quad hypot(Quad x, Quad y);
Quad fmod(Quad x, Quad y);
Quad floor(Quad x);
Quad round(Quad x);
constexpr Quad abs(Quad x) { return x.value < 0 ? -x : x; }
constexpr Quad fabs(Quad x) { return abs(x); }
constexpr Quad min(Quad a, Quad b) { return b < a ? b : a; }
constexpr Quad max(Quad a, Quad b) { return a < b ? b : a; }
constexpr bool isfinite(Quad x) { return x.value - x.value == 0; }
constexpr bool isnan(Quad x) { return x.value != x.value; }

/// Shortest form that reads back is not needed here: 36 significant digits always do.
std::string to_string(Quad x);

/// Parses a decimal number in full precision; the whole text must be one.
/// @throws std::invalid_argument
Quad parse_quad(const std::string& text);

namespace detail {
constexpr Binary128 power_of_ten(int n) {
  Binary128 p = 1;
  for (int i = 0; i < n; ++i) p *= 10;
  return p;
}
}  // namespace detail

/// A decimal literal in full precision: `0.0380944974224121954569753223086375653406_q`.
///
/// Digits are gathered in groups that are exact in 113 bits, so the result is within an ulp of the decimal, at
/// compile time. Only digits and a point: no exponent.
constexpr Quad operator""_q(const char* text) {
  constexpr int group = 30;
  Binary128 result = 0, digits = 0;
  int in_group = 0, decimals = 0;
  bool after_point = false;
  for (; *text != '\0'; ++text) {
    if (*text == '\'') continue;
    if (*text == '.') {
      after_point = true;
      continue;
    }
    if (*text < '0' || *text > '9') throw "a _q literal may contain only digits and a decimal point";
    if (in_group == group && after_point) {
      result += digits / detail::power_of_ten(decimals);
      digits = 0;
      in_group = 0;
    }
    digits = digits * 10 + (*text - '0');
    if (in_group > 0 || digits != 0) ++in_group;
    if (after_point) ++decimals;
    if (decimals == 48) break;  // 10^48 is the last power that is exact in 113 bits
  }
  return Quad::from(result + digits / detail::power_of_ten(decimals));
}

/// The value as a sum of three doubles, exact: how a Quad is written to files.
constexpr std::array<double, 3> to_doubles(Quad x) {
  const double a = static_cast<double>(x);
  const double b = static_cast<double>(x - Quad(a));
  return {a, b, static_cast<double>(x - Quad(a) - Quad(b))};
}
constexpr Quad from_doubles(const std::array<double, 3>& d) { return Quad(d[0]) + Quad(d[1]) + Quad(d[2]); }

}  // namespace noether

namespace std {
template <> class numeric_limits<noether::Quad> {
 public:
  static constexpr bool is_specialized = true, is_signed = true, is_integer = false, is_exact = false;
  static constexpr bool has_infinity = true, has_quiet_NaN = true, has_signaling_NaN = false;
  static constexpr bool is_iec559 = true, is_bounded = true, is_modulo = false, traps = false;
  static constexpr bool tinyness_before = false;
  static constexpr float_denorm_style has_denorm = denorm_present;
  static constexpr bool has_denorm_loss = false;
  static constexpr float_round_style round_style = round_to_nearest;
  static constexpr int digits = 113, digits10 = 33, max_digits10 = 36, radix = 2;
  static constexpr int min_exponent = -16381, max_exponent = 16384, min_exponent10 = -4931, max_exponent10 = 4932;
  static constexpr noether::Quad epsilon() { return noether::Quad::from(power(-112)); }
  static constexpr noether::Quad min() { return noether::Quad::from(power(-16382)); }
  static constexpr noether::Quad max() { return noether::Quad::from((2 - power(-112)) * power(16383)); }
  static constexpr noether::Quad lowest() { return -max(); }
  static constexpr noether::Quad infinity() { return noether::Quad(std::numeric_limits<double>::infinity()); }
  static constexpr noether::Quad quiet_NaN() { return noether::Quad(std::numeric_limits<double>::quiet_NaN()); }
  static constexpr noether::Quad round_error() { return noether::Quad(0.5); }
  static constexpr noether::Quad denorm_min() { return noether::Quad::from(power(-16382) * power(-112)); }

 private:
  static constexpr noether::Binary128 power(int n) {
    noether::Binary128 p = 1, base = n < 0 ? 0.5 : 2;
    for (unsigned m = static_cast<unsigned>(n < 0 ? -n : n); m != 0; m >>= 1) {
      if (m & 1U) p *= base;
      if (m > 1) base *= base;
    }
    return p;
  }
};
}  // namespace std

namespace Eigen {
template <> struct NumTraits<noether::Quad> : GenericNumTraits<noether::Quad> {
  using Real = noether::Quad;
  using NonInteger = noether::Quad;
  using Literal = double;
  using Nested = noether::Quad;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 2,
    AddCost = 40,
    MulCost = 40
  };
};
}  // namespace Eigen

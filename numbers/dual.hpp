#pragma once
/// Dual numbers: a value and its derivatives in n directions, carried through every operation.

#include "numbers/real.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace noether {

/// a + sum b_k e_k with e_j e_k = 0: arithmetic on these is differentiation, exact to rounding.
///
///     f(a + b e) = f(a) + f'(a) b e
///
/// Comparisons see the value only. `Real` may be dual itself: Dual<Dual<Real, 1>, 1> carries second derivatives.
/// @throws never
/// @cost n + 1 times an operation on Real
template <class Real, std::size_t n> struct Dual {
  Real value = Real(0);
  std::array<Real, n> slope = zeros();

  Dual() = default;
  Dual(const Real& x) : value(x) {}  // NOLINT: a constant has no slope
  template <class T>
    requires(std::is_arithmetic_v<T> && !std::is_same_v<T, Real>)
  Dual(T x) : value(Real(x)) {}  // NOLINT: widening

  /// The variable itself in direction `k`.
  static Dual variable(const Real& x, std::size_t k) {
    Dual result(x);
    result.slope[k] = Real(1);
    return result;
  }

  Dual operator+() const { return *this; }
  Dual operator-() const { return chain(-value, Real(-1)); }
  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }
  friend Dual operator+(const Dual& a, const Dual& b) { return join(a.value + b.value, a, Real(1), b, Real(1)); }
  friend Dual operator-(const Dual& a, const Dual& b) { return join(a.value - b.value, a, Real(1), b, Real(-1)); }
  friend Dual operator*(const Dual& a, const Dual& b) { return join(a.value * b.value, a, b.value, b, a.value); }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const Real quotient = a.value / b.value;
    return join(quotient, a, Real(1) / b.value, b, -quotient / b.value);
  }
  friend auto operator==(const Dual& a, const Dual& b) { return a.value == b.value; }
  friend auto operator!=(const Dual& a, const Dual& b) { return a.value != b.value; }
  friend auto operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend auto operator>(const Dual& a, const Dual& b) { return b.value < a.value; }
  friend auto operator<=(const Dual& a, const Dual& b) { return a.value <= b.value; }
  friend auto operator>=(const Dual& a, const Dual& b) { return b.value <= a.value; }

  friend Dual sqrt(const Dual& a) {
    using std::sqrt;
    const Real root = sqrt(a.value);
    return a.chain(root, Real(1) / (Real(2) * root));
  }
  friend Dual sin(const Dual& a) {
    using std::sin, std::cos;
    return a.chain(sin(a.value), cos(a.value));
  }
  friend Dual cos(const Dual& a) {
    using std::sin, std::cos;
    return a.chain(cos(a.value), -sin(a.value));
  }
  friend Dual tan(const Dual& a) {
    using std::tan;
    const Real t = tan(a.value);
    return a.chain(t, Real(1) + t * t);
  }
  friend Dual acos(const Dual& a) {
    using std::acos, std::sqrt;
    return a.chain(acos(a.value), Real(-1) / sqrt(Real(1) - a.value * a.value));
  }
  friend Dual atan2(const Dual& y, const Dual& x) {
    using std::atan2;
    const Real r2 = x.value * x.value + y.value * y.value;
    return join(atan2(y.value, x.value), y, x.value / r2, x, -y.value / r2);
  }
  friend Dual exp(const Dual& a) {
    using std::exp;
    const Real e = exp(a.value);
    return a.chain(e, e);
  }
  friend Dual log(const Dual& a) {
    using std::log;
    return a.chain(log(a.value), Real(1) / a.value);
  }
  friend Dual sinh(const Dual& a) {
    using std::sinh, std::cosh;
    return a.chain(sinh(a.value), cosh(a.value));
  }
  friend Dual cosh(const Dual& a) {
    using std::sinh, std::cosh;
    return a.chain(cosh(a.value), sinh(a.value));
  }
  friend Dual cbrt(const Dual& a) {
    using std::cbrt;
    const Real root = cbrt(a.value);
    return a.chain(root, Real(1) / (Real(3) * root * root));
  }
  friend Dual asin(const Dual& a) {
    using std::asin, std::sqrt;
    return a.chain(asin(a.value), Real(1) / sqrt(Real(1) - a.value * a.value));
  }
  friend Dual atan(const Dual& a) {
    using std::atan;
    return a.chain(atan(a.value), Real(1) / (Real(1) + a.value * a.value));
  }
  friend Dual tanh(const Dual& a) {
    using std::tanh;
    const Real t = tanh(a.value);
    return a.chain(t, Real(1) - t * t);
  }
  friend Dual asinh(const Dual& a) {
    using std::asinh, std::sqrt;
    return a.chain(asinh(a.value), Real(1) / sqrt(a.value * a.value + Real(1)));
  }
  friend Dual acosh(const Dual& a) {
    using std::acosh, std::sqrt;
    return a.chain(acosh(a.value), Real(1) / sqrt(a.value * a.value - Real(1)));
  }
  friend Dual atanh(const Dual& a) {
    using std::atanh;
    return a.chain(atanh(a.value), Real(1) / (Real(1) - a.value * a.value));
  }
  friend Dual expm1(const Dual& a) {
    using std::expm1, std::exp;
    return a.chain(expm1(a.value), exp(a.value));
  }
  friend Dual log1p(const Dual& a) {
    using std::log1p;
    return a.chain(log1p(a.value), Real(1) / (Real(1) + a.value));
  }
  friend Dual erf(const Dual& a) {
    using std::erf;
    return a.chain(erf(a.value), bell(a.value));
  }
  friend Dual erfc(const Dual& a) {
    using std::erfc;
    return a.chain(erfc(a.value), -bell(a.value));
  }
  friend Dual hypot(const Dual& a, const Dual& b) {
    using std::hypot;
    const Real length = hypot(a.value, b.value);
    return join(length, a, a.value / length, b, b.value / length);
  }
  /// Whole numbers have no slope.
  friend Dual floor(const Dual& a) {
    using std::floor;
    return Dual(floor(a.value));
  }
  friend Dual ceil(const Dual& a) {
    using std::ceil;
    return Dual(ceil(a.value));
  }
  friend Dual round(const Dual& a) {
    using std::round;
    return Dual(round(a.value));
  }
  friend Dual fmod(const Dual& a, const Dual& b) {
    using std::fmod;
    const Real left = fmod(a.value, b.value);
    return join(left, a, Real(1), b, (left - a.value) / b.value);
  }
  friend Dual pow(const Dual& a, const Dual& p) {
    using std::pow, std::log;
    const Real power = pow(a.value, p.value), rate = p.value * pow(a.value, p.value - Real(1));
    // An exponent that stays as it is has no slope to give, not even where there is no logarithm.
    Dual result = join(power, a, rate, p, power * log(a.value));
    for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
      result.slope[k] = select(p.slope[k] == Real(0), Real(rate * a.slope[k]), result.slope[k]);
    }
    return result;
  }
  /// a^p with a constant exponent.
  friend Dual pow(const Dual& a, const Real& p) {
    using std::pow;
    return a.chain(pow(a.value, p), p * pow(a.value, p - Real(1)));
  }
  template <class T>
    requires std::is_arithmetic_v<T>
  friend Dual pow(const Dual& a, T p) { return pow(a, Real(p)); }
  friend Dual abs(const Dual& a) { return select(a.value < Real(0), -a, a); }
  friend Dual fabs(const Dual& a) { return abs(a); }
  friend Dual min(const Dual& a, const Dual& b) { return select(b < a, b, a); }
  friend Dual max(const Dual& a, const Dual& b) { return select(a < b, b, a); }
  friend auto isfinite(const Dual& a) {
    using std::isfinite;
    return isfinite(a.value);
  }
  friend auto isnan(const Dual& a) {
    using std::isnan;
    return isnan(a.value);
  }

 private:
  static std::array<Real, n> zeros() {
    std::array<Real, n> zero{};
    zero.fill(Real(0));
    return zero;
  }
  /// The derivative of erf, 2 exp(-x^2) / sqrt(pi).
  static Real bell(const Real& x) {
    using std::exp, std::sqrt, std::atan;
    return exp(-x * x) / sqrt(atan(Real(1)));
  }
  /// The value of a function here, and its derivative times the slopes.
  Dual chain(const Real& at, const Real& derivative) const {
    Dual result(at);
    for (std::size_t k = 0; k < n; ++k) result.slope[k] = derivative * slope[k];
    return result;
  }
  static Dual join(const Real& at, const Dual& a, const Real& by_a, const Dual& b, const Real& by_b) {
    Dual result(at);
    for (std::size_t k = 0; k < n; ++k) result.slope[k] = by_a * a.slope[k] + by_b * b.slope[k];
    return result;
  }
};

/// In lanes the value and every slope are chosen lane by lane.
template <class Condition, class Real, std::size_t n>
  requires(!std::is_same_v<Condition, bool>)
Dual<Real, n> select(const Condition& condition, const Dual<Real, n>& a, const Dual<Real, n>& b) {
  Dual<Real, n> result(select(condition, a.value, b.value));
  for (std::size_t k = 0; k < n; ++k) result.slope[k] = select(condition, a.slope[k], b.slope[k]);
  return result;
}

namespace detail {
/// x + e dx.
template <class Real> Dual<Real, 1> along(const Real& x, const Real& dx) {
  Dual<Real, 1> moved(x);
  moved.slope[0] = dx;
  return moved;
}
}  // namespace detail

}  // namespace noether

namespace Eigen {
template <class Real, std::size_t n> struct NumTraits<noether::Dual<Real, n>> : NumTraits<Real> {
  using Real_ = noether::Dual<Real, n>;
  using NonInteger = Real_;
  using Nested = Real_;
  enum { RequireInitialization = 1 };
};
}  // namespace Eigen

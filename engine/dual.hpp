#pragma once
/// Dual numbers: a value and its derivatives in n directions, carried through every operation.

#include "engine/real.hpp"

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
  friend bool operator==(const Dual& a, const Dual& b) { return a.value == b.value; }
  friend bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend bool operator>(const Dual& a, const Dual& b) { return b < a; }
  friend bool operator<=(const Dual& a, const Dual& b) { return !(b < a); }
  friend bool operator>=(const Dual& a, const Dual& b) { return !(a < b); }

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
  /// a^p with a constant exponent.
  friend Dual pow(const Dual& a, const Real& p) {
    using std::pow;
    return a.chain(pow(a.value, p), p * pow(a.value, p - Real(1)));
  }
  friend Dual abs(const Dual& a) { return a.value < Real(0) ? -a : a; }
  friend bool isfinite(const Dual& a) {
    using std::isfinite;
    return isfinite(a.value);
  }

 private:
  static std::array<Real, n> zeros() {
    std::array<Real, n> zero{};
    zero.fill(Real(0));
    return zero;
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

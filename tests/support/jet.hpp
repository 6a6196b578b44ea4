#pragma once
/// Truncated power series as a number type: the same code that steps a system, run with `Jet`, yields its Taylor
/// series.

#include "integrators/scheme.hpp"
#include "numbers/real.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <type_traits>

namespace noether {

/// c_0 + c_1 h + ... + c_n h^n + O(h^(n+1)), with coefficients in 113 bits.
/// @cost (n + 1)(n + 2)/2 products of Quad a product
template <int n> class Jet {
 public:
  static constexpr std::size_t terms = n + 1;

  constexpr Jet() = default;
  template <class T>
    requires std::is_arithmetic_v<T>
  constexpr Jet(T x) {  // NOLINT: widening is exact
    c_[0] = Quad(x);
  }
  constexpr Jet(Quad x) { c_[0] = x; }  // NOLINT: exact

  /// The series h.
  static constexpr Jet variable() {
    Jet h;
    h[1] = 1;
    return h;
  }

  constexpr Quad operator[](std::size_t k) const { return c_[k]; }
  constexpr Quad& operator[](std::size_t k) { return c_[k]; }
  constexpr explicit operator double() const { return static_cast<double>(c_[0]); }

  constexpr Jet operator+() const { return *this; }
  constexpr Jet operator-() const { return Jet() -= *this; }
  constexpr Jet& operator+=(const Jet& b) {
    for (std::size_t k = 0; k < terms; ++k) c_[k] += b.c_[k];
    return *this;
  }
  constexpr Jet& operator-=(const Jet& b) {
    for (std::size_t k = 0; k < terms; ++k) c_[k] -= b.c_[k];
    return *this;
  }
  constexpr Jet& operator*=(const Jet& b) { return *this = *this * b; }
  constexpr Jet& operator/=(const Jet& b) { return *this = *this / b; }

  friend constexpr Jet operator+(Jet a, const Jet& b) { return a += b; }
  friend constexpr Jet operator-(Jet a, const Jet& b) { return a -= b; }
  friend constexpr Jet operator*(const Jet& a, const Jet& b) {
    Jet product;
    for (std::size_t j = 0; j < terms; ++j) {
      if (a.c_[j] == Quad(0)) continue;  // numbers and low powers of h are cheap
      for (std::size_t k = 0; j + k < terms; ++k) product.c_[j + k] += a.c_[j] * b.c_[k];
    }
    return product;
  }
  /// Long division; the divisor must have a constant term.
  friend constexpr Jet operator/(const Jet& a, const Jet& b) {
    Jet quotient;
    for (std::size_t k = 0; k < terms; ++k) {
      Quad left = a.c_[k];
      for (std::size_t j = 1; j <= k; ++j) left -= b.c_[j] * quotient.c_[k - j];
      quotient.c_[k] = left / b.c_[0];
    }
    return quotient;
  }
  friend constexpr bool operator==(const Jet& a, const Jet& b) { return a.c_ == b.c_; }

 private:
  std::array<Quad, terms> c_{};
};

/// The square root with positive constant term: from (sum r_k h^k)^2 = sum x_k h^k, coefficient by coefficient.
template <int n> Jet<n> sqrt(const Jet<n>& x) {
  Jet<n> root;
  root[0] = sqrt(x[0]);
  for (std::size_t k = 1; k < Jet<n>::terms; ++k) {
    Quad left = x[k];
    for (std::size_t j = 1; j < k; ++j) left -= root[j] * root[k - j];
    root[k] = left / (Quad(2) * root[0]);
  }
  return root;
}

/// The integral from 0 to h.
template <int n> Jet<n> integral(const Jet<n>& x) {
  Jet<n> sum;
  for (std::size_t k = 1; k < Jet<n>::terms; ++k) sum[k] = x[k - 1] / Quad(static_cast<int>(k));
  return sum;
}

template <int n> bool isfinite(const Jet<n>& x) {
  for (std::size_t k = 0; k < Jet<n>::terms; ++k) {
    if (!isfinite(x[k])) return false;
  }
  return true;
}

}  // namespace noether

namespace Eigen {
template <int n> struct NumTraits<noether::Jet<n>> : GenericNumTraits<noether::Jet<n>> {
  using Real = noether::Jet<n>;
  using NonInteger = noether::Jet<n>;
  using Literal = double;
  using Nested = noether::Jet<n>;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 2 * (n + 1),
    AddCost = 40 * (n + 1),
    MulCost = 40 * (n + 1) * (n + 1)
  };
};
}  // namespace Eigen

namespace noether::test {

/// A point of phase space with two coordinates.
template <class Number> struct Phase2 { std::array<Number, 2> q, p; };

/// One step along a word, H = T(p) + U(q):  A: q += w h T'(p),  B: p -= w h U'(q).
/// `model` offers `velocity(p)` and `force(q)` for every number type.
template <class Number, class Model>
Phase2<Number> walked(const Word& word, const Model& model, Phase2<Number> s, const Number& h) {
  for (const Stage& stage : word) {
    auto& moved = stage.letter == 'A' ? s.q : s.p;
    const auto rate = stage.letter == 'A' ? model.velocity(s.p) : model.force(s.q);
    for (std::size_t i = 0; i < 2; ++i) moved[i] += Number(stage.weight) * h * rate[i];
  }
  return s;
}

/// The Taylor series of the exact flow: Picard's iteration, each round of which makes one more power right.
template <int n, class Model> Phase2<Jet<n>> taylor_flow(const Model& model, const Phase2<Jet<n>>& start) {
  Phase2<Jet<n>> s = start;
  for (int round = 0; round < n; ++round) {
    const auto velocity = model.velocity(s.p), force = model.force(s.q);
    for (std::size_t i = 0; i < 2; ++i) {
      s.q[i] = start.q[i] + integral(velocity[i]);
      s.p[i] = start.p[i] + integral(force[i]);
    }
  }
  return s;
}

/// A potential with all 12 monomials of degree 2 to 4 in two coordinates, its coefficients drawn at random, and
/// T = p^2/2 + (quartic/4) (p . p)^2: with `quartic` = 0 the class of Runge-Kutta-Nystroem methods, else outside of it.
class QuarticModel {
 public:
  explicit QuarticModel(std::uint64_t seed, double quartic = 0) : quartic_(quartic) {
    std::mt19937_64 bits(seed);  // its bits are the same everywhere, unlike those of a distribution
    for (auto& row : u_) {
      for (Quad& coefficient : row)
        coefficient = Quad(static_cast<std::int64_t>(bits() >> 33)) / Quad(1LL << 30) - Quad(1);
    }
  }

  template <class Number> std::array<Number, 2> velocity(const std::array<Number, 2>& p) const {
    if (quartic_ == Quad(0)) return p;
    const Number factor = Number(1) + Number(quartic_) * (p[0] * p[0] + p[1] * p[1]);
    return {p[0] * factor, p[1] * factor};
  }

  /// -U'(q), U = sum u_jk x^j y^k over 2 <= j + k <= 4.
  template <class Number> std::array<Number, 2> force(const std::array<Number, 2>& q) const {
    const auto x = powers(q[0]), y = powers(q[1]);
    std::array<Number, 2> f{Number(0), Number(0)};
    for (std::size_t j = 0; j <= 4; ++j) {
      for (std::size_t k = 0; j + k <= 4; ++k) {
        if (j + k < 2) continue;
        if (j > 0) f[0] -= Number(u_[j][k] * Quad(static_cast<int>(j))) * (x[j - 1] * y[k]);
        if (k > 0) f[1] -= Number(u_[j][k] * Quad(static_cast<int>(k))) * (x[j] * y[k - 1]);
      }
    }
    return f;
  }

 private:
  template <class Number> static std::array<Number, 5> powers(const Number& x) {
    const Number x2 = x * x;
    return {Number(1), x, x2, x2 * x, x2 * x2};
  }

  std::array<std::array<Quad, 5>, 5> u_{};
  Quad quartic_;
};

inline constexpr int jet_degree = 11;

/// A start at which nothing is special.
template <class Number> Phase2<Number> generic_start() {
  return {{Number(Quad(3) / Quad(7)), Number(Quad(-5) / Quad(11))},
          {Number(Quad(4) / Quad(9)), Number(Quad(2) / Quad(5))}};
}

/// Largest coefficient of h^k, k = 0 ... 11, in one step along a word less the exact flow.
template <class Model> std::array<Quad, jet_degree + 1> local_error(const Word& word, const Model& model) {
  using J = Jet<jet_degree>;
  const auto start = generic_start<J>();
  const auto step = walked(word, model, start, J::variable());
  const auto exact = taylor_flow(model, start);
  std::array<Quad, jet_degree + 1> worst{};
  for (std::size_t k = 0; k <= jet_degree; ++k) {
    for (std::size_t i = 0; i < 2; ++i) {
      worst[k] = std::max({worst[k], abs(step.q[i][k] - exact.q[i][k]), abs(step.p[i][k] - exact.p[i][k])});
    }
  }
  return worst;
}

/// The order that a local error shows: one less than its first power above a tolerance.
inline int order_of(const std::array<Quad, jet_degree + 1>& error, Quad tolerance = Quad(1e-12)) {
  int k = 0;
  while (k <= jet_degree && error[static_cast<std::size_t>(k)] < tolerance) ++k;
  return k - 1;
}

}  // namespace noether::test

#pragma once
/// What a constraint is: a function of some particles' positions that stays 0. Everything else follows from it.

#include "numbers/dual.hpp"
#include "numbers/types.hpp"

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace noether {

/// Positions of the n particles that a constraint ties.
template <class Real, std::size_t n> using Points = std::array<Vec3<Real>, n>;

/// What pictures show of a constraint.
enum class Drawn : std::uint8_t {
  nothing,
  link,   ///< a line between its two particles
  chain,  ///< a line through all of its particles, in their order
  rod,    ///< a line from its `center` to its particle
};

/// A holonomic constraint g(q) = 0 on `particles` particles: one equation, or several as an array.
///
///     struct OnParabola {                                    // z = a x^2
///       static constexpr std::size_t particles = 1;
///       double a = 1;
///       template <class Real> Real value(const Points<Real, 1>& x) const {
///         return x[0][2] - Real(a) * x[0][0] * x[0][0];
///       }
///       double scale() const { return 1 / a; }               // above 0: what |g| is small beside
///     };
///
/// Gradients come by dual numbers unless it offers `gradient(x)`, one array of `Points` for each equation. A constraint
/// whose `residual(g)` differs from |g| / scale says so itself; one that takes what it was not told from the particles
/// offers `at_start(x)`; one that makes no sense throws in `check()`. `keeps_momentum` and `keeps_angular_momentum`
/// (false unless declared; the latter may be a function) say that its forces have no sum, and no torque about the
/// origin. `static constexpr Drawn drawn` says what pictures show of it.
///
/// In a periodic box each particle stands at its image nearest to the one before. One that keeps momentum sees nothing
/// but differences; any other holds particles where they would be had they never been wrapped. One whose `reach()` says
/// how far apart it holds its particles is refused where that is no nearest image: from half of an edge on.
template <class C>
concept Constraint = requires(const C& c, const Points<double, C::particles>& x) {
  { C::particles } -> std::convertible_to<std::size_t>;
  c.value(x);
};

namespace detail {

template <class Value> struct equations_of : std::integral_constant<std::size_t, 1> {};
template <class Real, std::size_t m>
struct equations_of<std::array<Real, m>> : std::integral_constant<std::size_t, m> {};

/// Equations of a constraint.
template <class C>
inline constexpr std::size_t equations =
    equations_of<decltype(std::declval<const C&>().value(std::declval<const Points<double, C::particles>&>()))>::value;

template <class C, class Real> using Values = std::array<Real, equations<C>>;
template <class C, class Real> using Gradients = std::array<Points<Real, C::particles>, equations<C>>;

template <class C, class Real> Values<C, Real> values_of(const C& constraint, const Points<Real, C::particles>& x) {
  if constexpr (requires { constraint.value(x)[0][0]; }) {
    return constraint.value(x);
  } else {
    return Values<C, Real>{constraint.value(x)};
  }
}

template <class C, class Real>
Gradients<C, Real> gradients_of(const C& constraint, const Points<Real, C::particles>& x) {
  if constexpr (requires { constraint.gradient(x)[0][0][0]; }) {
    return constraint.gradient(x);
  } else {
    constexpr std::size_t n = C::particles;
    using D = Dual<Real, 3 * n>;
    Points<D, n> variable;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        variable[i][static_cast<Index>(k)] = D::variable(x[i][static_cast<Index>(k)], 3 * i + k);
      }
    }
    const auto g = values_of<C, D>(constraint, variable);
    Gradients<C, Real> result;
    for (std::size_t e = 0; e < g.size(); ++e) {
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < 3; ++k) result[e][i][static_cast<Index>(k)] = g[e].slope[3 * i + k];
      }
    }
    return result;
  }
}

/// d^2/dt^2 g(x + t v) at t = 0, which is v . g_qq v.
template <class C, class Real>
Values<C, Real> curvatures_of(const C& constraint, const Points<Real, C::particles>& x,
                              const Points<Real, C::particles>& v) {
  using Inner = Dual<Real, 1>;
  using Outer = Dual<Inner, 1>;
  Points<Outer, C::particles> moving;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (Index k = 0; k < 3; ++k) {
      Inner at(x[i][k]);
      at.slope[0] = v[i][k];
      moving[i][k] = Outer(at);
      moving[i][k].slope[0] = Inner(v[i][k]);
    }
  }
  const auto g = values_of<C, Outer>(constraint, moving);
  Values<C, Real> result;
  for (std::size_t e = 0; e < g.size(); ++e) result[e] = g[e].slope[0].slope[0];
  return result;
}

template <class C> double scale_of(const C& constraint) {
  if constexpr (requires { constraint.scale(); }) {
    return constraint.scale();
  } else {
    return 1;
  }
}

/// How far apart a constraint holds its particles [length]; 0 where it does not tell.
template <class C> double reach_of(const C& constraint) {
  if constexpr (requires { constraint.reach(); }) {
    return constraint.reach();
  } else {
    return 0;
  }
}

/// How far a constraint is from being kept, relative to its scale [1].
template <class C> double residual_of(const C& constraint, double g) {
  if constexpr (requires { constraint.residual(g); }) {
    return constraint.residual(g);
  } else {
    return (g < 0 ? -g : g) / scale_of(constraint);
  }
}

template <class C> constexpr bool keeps_momentum() {
  if constexpr (requires { C::keeps_momentum; }) return C::keeps_momentum;
  return false;
}
template <class C> bool keeps_angular_momentum(const C& constraint) {
  if constexpr (requires { constraint.keeps_angular_momentum(); }) {
    return constraint.keeps_angular_momentum();
  } else if constexpr (requires { C::keeps_angular_momentum; }) {
    return C::keeps_angular_momentum;
  } else {
    return false;
  }
}

}  // namespace detail

}  // namespace noether

#pragma once
/// Orbital elements of a Kepler orbit, from and to position and velocity.

#include "numbers/error.hpp"
#include "numbers/real.hpp"
#include "numbers/types.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace noether {

/// Osculating elements about a center of attraction.
///
/// An ellipse has a > 0 and e < 1, a hyperbola a < 0 and e > 1. Angles are in radians; Omega, omega and the M of an
/// ellipse lie in [0, 2 pi), inc in [0, pi], the M of a hyperbola is any number. Where an angle has no meaning:
///
///     inc = 0 or pi    Omega = 0: the node is the x axis
///     e = 0            omega = 0: the pericenter is the node
/// @source MurrayDermott1999
template <class Real> struct OrbitalElements {
  Real a;      ///< semi-major axis [length]
  Real e;      ///< eccentricity [1]
  Real inc;    ///< inclination [angle]
  Real Omega;  ///< longitude of the ascending node [angle]
  Real omega;  ///< argument of the pericenter [angle]
  Real M;      ///< mean anomaly [angle]
};

namespace detail {

template <class Real> Real full_turn() {
  return static_cast<Real>(6.28318530717958647692528676655900576839433879875021_q);
}

/// The same angle in [0, 2 pi).
template <class Real> Real positive_angle(const Real& angle) {
  using std::floor;
  const Real turn = full_turn<Real>();
  const Real reduced = angle - turn * floor(angle / turn);
  return reduced >= turn || reduced < Real(0) ? Real(0) : reduced;
}

/// x - sin x for sign = -1, sinh x - x for sign = +1, by the series, for |x| <= 1.
template <class Real> Real odd_series(const Real& x, int sign) {
  using std::abs;
  const Real z = Real(sign) * x * x;
  Real term = x * x * x / Real(6), sum = term;
  for (int k = 4; abs(term) > std::numeric_limits<Real>::epsilon() * abs(sum) / Real(8); k += 2) {
    term *= z / Real(k * (k + 1));
    sum += term;
  }
  return sum;
}

/// E - sin E without cancellation.
template <class Real> Real angle_minus_sine(const Real& E) {
  using std::abs;
  using std::sin;
  return abs(E) < Real(1) ? odd_series(E, -1) : E - sin(E);
}

/// sinh H - H without cancellation.
template <class Real> Real sinh_minus_argument(const Real& H) {
  using std::abs;
  using std::sinh;
  return abs(H) < Real(1) ? odd_series(H, 1) : sinh(H) - H;
}

/// Newton's method from the right on a convex, increasing function: it falls until rounding stops it.
/// @param step  f / f' at a point
template <class Real, class Step> Real descend(Real x, const Step& step) {
  constexpr int cap = 200;
  for (int k = 0; k < cap; ++k) {
    const Real next = x - step(x);
    if (!(next < x)) break;
    x = next;
  }
  return x;
}

/// Solves M = E - e sin E, written as (1 - e) E + e (E - sin E), for the eccentric anomaly E in [-pi, pi].
template <class Real> Real eccentric_anomaly(const Real& M, const Real& e) {
  using std::abs;
  using std::cbrt;
  using std::round;
  using std::sin;
  const Real turn = full_turn<Real>(), pi = turn / Real(2);
  const Real reduced = M - turn * round(M / turn), m = abs(reduced), one_minus_e = Real(1) - e;
  if (m == Real(0)) return reduced;
  // E - sin E >= E^3/pi^2 on [0, pi]: three bounds from above.
  Real E = std::min(pi, Real(m / one_minus_e));
  if (e > Real(0)) E = std::min(E, Real(cbrt(pi * pi * m / e)));
  E = descend(E, [&](const Real& x) {
    const Real half = sin(x / Real(2));
    return (one_minus_e * x + e * angle_minus_sine(x) - m) / (one_minus_e + Real(2) * e * half * half);
  });
  return reduced < Real(0) ? -E : E;
}

/// Solves M = e sinh H - H, written as (e - 1) H + e (sinh H - H).
template <class Real> Real hyperbolic_anomaly(const Real& M, const Real& e) {
  using std::abs;
  using std::asinh;
  using std::cbrt;
  using std::sinh;
  const Real m = abs(M), e_minus_one = e - Real(1);
  if (m == Real(0)) return M;
  Real H = std::min(Real(m / e_minus_one), Real(cbrt(Real(6) * m / e)));
  H = std::min(H, Real(asinh((m + H) / e)));
  H = descend(H, [&](const Real& x) {
    const Real half = sinh(x / Real(2));
    return (e_minus_one * x + e * sinh_minus_argument(x) - m) / (e_minus_one + Real(2) * e * half * half);
  });
  return M < Real(0) ? -H : H;
}

/// Tells which element makes these no orbit. Where a and e contradict each other, e is taken for wrong beside a
/// positive a, and a beside the e of an ellipse.
/// @throws Error  always, with the key and the value of that element
[[noreturn]] void refuse_elements(const OrbitalElements<double>& o, double mu);

template <class Real> void check_elements(const OrbitalElements<Real>& o, const Real& mu) {
  bool fine = mu > Real(0);
  for (const Real* x : {&o.a, &o.e, &o.inc, &o.Omega, &o.omega, &o.M}) fine = fine && *x - *x == Real(0);
  const bool ellipse = o.a > Real(0) && o.e >= Real(0) && o.e < Real(1);
  const bool hyperbola = o.a < Real(0) && o.e > Real(1);
  if (fine && (ellipse || hyperbola)) return;
  const auto plain = [](const Real& x) { return static_cast<double>(x); };
  refuse_elements({plain(o.a), plain(o.e), plain(o.inc), plain(o.Omega), plain(o.omega), plain(o.M)}, plain(mu));
}

}  // namespace detail

/// Position and velocity relative to the center of attraction.
///
///     x = a (cos E - e),  y = a sqrt(1 - e^2) sin E  in the plane of the orbit;  M = E - e sin E
///
/// Kepler's equation is solved to rounding for every e; the state is as exact as its elements define it.
/// @param mu  G times the sum of both masses [length^3/time^2]
/// @return x [length] and v [length/time]
/// @throws Error  if the elements are no ellipse and no hyperbola, or mu is not positive
/// @source MurrayDermott1999
template <class Real> std::pair<Vec3<Real>, Vec3<Real>> state_from_elements(const OrbitalElements<Real>& o, Real mu) {
  using std::abs;
  using std::cos;
  using std::cosh;
  using std::sin;
  using std::sinh;
  using std::sqrt;
  detail::check_elements(o, mu);
  const Real one_minus_e = Real(1) - o.e, b = sqrt(abs(one_minus_e) * (Real(1) + o.e)), size = abs(o.a);
  Real c, s, half;  // cosine, sine, sine of the half, circular or hyperbolic
  const bool ellipse = o.a > Real(0);
  if (ellipse) {
    const Real E = detail::eccentric_anomaly(o.M, o.e);
    c = cos(E), s = sin(E), half = sin(E / Real(2));
  } else {
    const Real H = detail::hyperbolic_anomaly(o.M, o.e);
    c = cosh(H), s = sinh(H), half = sinh(H / Real(2));
  }
  const Real square = Real(2) * half * half;
  const Real r = size * (abs(one_minus_e) + o.e * square);
  const Real along = size * (abs(one_minus_e) - square), across = size * b * s;
  const Real speed = sqrt(mu * size) / r, along_rate = -speed * s, across_rate = speed * b * c;

  const Real co = cos(o.omega), so = sin(o.omega), ci = cos(o.inc), si = sin(o.inc);
  const Real cO = cos(o.Omega), sO = sin(o.Omega);
  const Vec3<Real> p(cO * co - sO * so * ci, sO * co + cO * so * ci, so * si);
  const Vec3<Real> q(-cO * so - sO * co * ci, -sO * so + cO * co * ci, co * si);
  return {along * p + across * q, along_rate * p + across_rate * q};
}

/// The elements of the Kepler orbit through a position and velocity relative to the center of attraction.
///
/// A parabola (to rounding) has a = infinity and no M; motion on a straight line has no plane: inc, Omega, omega are
/// NaN. Nothing is thrown: monitors call this within a run.
/// @param mu  G times the sum of both masses [length^3/time^2]
/// @throws never
/// @source MurrayDermott1999
template <class Real> OrbitalElements<Real> elements_from_state(const Vec3<Real>& x, const Vec3<Real>& v, Real mu) {
  using std::abs;
  using std::asinh;
  using std::atan2;
  using std::sqrt;
  const Real none = std::numeric_limits<Real>::quiet_NaN();
  const Vec3<Real> h = cross(x, v);
  const Real r = sqrt(norm2(x)), h2 = norm2(h), radial = dot(x, v);
  const Real alpha = Real(2) / r - norm2(v) / mu;
  const Real one_minus_e2 = h2 * alpha / mu;
  const Real cosine = Real(1) - r * alpha, sine = radial * sqrt(abs(alpha) / mu);  // e cos E and e sin E, or e sinh H
  OrbitalElements<Real> o{Real(1) / alpha, Real(1), none, none, none, none};

  if (alpha > Real(0)) {
    o.e = sqrt(cosine * cosine + sine * sine);
    const Real E = atan2(sine, cosine);
    const Real M = one_minus_e2 / (Real(1) + o.e) * E + o.e * detail::angle_minus_sine(E);
    o.M = detail::positive_angle(M);
  } else if (alpha < Real(0)) {
    o.e = sqrt(Real(1) - one_minus_e2);
    const Real H = asinh(sine / o.e);
    o.M = -one_minus_e2 / (Real(1) + o.e) * H + o.e * detail::sinh_minus_argument(H);
  } else {
    o.a = std::numeric_limits<Real>::infinity();
  }
  if (!(h2 > Real(0))) return o;

  const Real in_plane = sqrt(h[0] * h[0] + h[1] * h[1]), length = sqrt(h2);
  Vec3<Real> node(Real(1), Real(0), Real(0));
  if (in_plane > Real(0)) node = Vec3<Real>(-h[1] / in_plane, h[0] / in_plane, Real(0));
  o.inc = atan2(in_plane, h[2]);
  o.Omega = detail::positive_angle<Real>(atan2(node[1], node[0]));
  const Real latitude = atan2(dot(x, cross(h, node)) / length, dot(x, node));
  // Pericenter and mean anomaly of a nearly circular orbit are uncertain, their sum is not: f follows from the E above.
  const bool low = o.e < Real(0.5);
  const Real anomaly = low ? atan2(sqrt(one_minus_e2) * sine, cosine - o.e * o.e)
                           : atan2(length * radial / (mu * r), h2 / (mu * r) - Real(1));  // e sin f, e cos f
  if (o.e == Real(0)) {
    o.omega = Real(0);
    o.M = detail::positive_angle(latitude);
  } else {
    o.omega = detail::positive_angle<Real>(latitude - anomaly);
  }
  return o;
}

}  // namespace noether

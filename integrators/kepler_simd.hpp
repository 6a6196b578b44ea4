#pragma once
/// Kepler arcs of eight planets side by side; for `*_simd.cpp` alone. docs/theory/kepler.md has the formulae.

#include "integrators/planet_rows.hpp"
#include "numbers/eight_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

/// Where arcs begin: r = |x|, eta = x . v, zeta = mu - beta r, beta = 2 mu/r - v^2.
struct EightOrbits {
  Eight r, r_inverse, eta, beta, zeta, mu, h;
};

/// Where a trial s is on the arcs, and the step to the root: `step` by Newton, `more` to third order.
struct EightTrials {
  Eight s, g0, g1, g2, g3, eta, zeta, step, more, turn;
};

/// The largest |beta s^2| within which the series below are good.
constexpr double widest_series = 2.5;

constexpr double one_over_factorial(int n) {
  double f = 1;  // whole up to 22!, rounded at 23! and 24!, where it does not matter
  for (int k = 2; k <= n; ++k) f *= k;
  return 1 / f;
}
/// What rounding takes from 1/n!. Constants always rounded the same way would make energies drift.
constexpr double one_over_factorial_low(int n) {
  __extension__ __float128 f = 1;
  for (int k = 2; k <= n; ++k) f *= k;
  return double(1 / f - one_over_factorial(n));
}

/// Coefficients k to 10 of c_n(z) = sum_k (-z)^k/(2k + n)!, by pairs.
template <int n, int k> NOETHER_EIGHT_INLINE Eight series(const Eight& z, const Eight& z2) {
  constexpr int sign = k % 2 == 0 ? 1 : -1;
  if constexpr (k == 10) {
    return Eight(one_over_factorial(2 * k + n));
  } else {
    const Eight head =
        Eight(-sign * one_over_factorial(2 * k + 2 + n)) * z + Eight(sign * one_over_factorial(2 * k + n));
    return series<n, k + 2>(z, z2) * z2 + head;
  }
}
template <int n> NOETHER_EIGHT_INLINE Eight stumpff(const Eight& z, const Eight& z2) {
  static_assert(n == 2 || n == 3);
  const Eight second =
      (series<n, 2>(z, z2) * z + Eight(-one_over_factorial_low(n + 2))) + Eight(-one_over_factorial(n + 2));
  if constexpr (n == 2) return second * z + Eight(0.5);
  return (second * z + Eight(one_over_factorial_low(n))) + Eight(one_over_factorial(n));
}

/// The universal functions at s.
NOETHER_EIGHT_INLINE EightTrials functions_at(const EightOrbits& o, const Eight& s) {
  EightTrials t;
  const Eight s2 = s * s, z = o.beta * s2, z2 = z * z;
  t.s = s;
  t.g2 = s2 * stumpff<2>(z, z2);
  t.g3 = (s2 * s) * stumpff<3>(z, z2);
  t.g1 = s - o.beta * t.g3;
  t.g0 = Eight(1.0) - o.beta * t.g2;
  return t;
}
/// What is missing in Kepler's equation at s, as the step that mends it:
///     d1 (1 - p/2 + p^2/2 - q/6),  d1 = missing/r,  p = eta d1/r,  q = zeta d1^2/r
NOETHER_EIGHT_INLINE void look_at(const EightOrbits& o, EightTrials& t) {
  const Eight r = (o.r + o.eta * t.s) + (o.zeta * t.g2 - (o.beta * o.eta) * t.g3), r_inverse = Eight(1.0) / r;
  const Eight missing = (o.h - o.r * t.s) - (o.eta * t.g2 + o.zeta * t.g3);
  t.eta = o.zeta * t.g1 + o.eta * t.g0;
  t.step = missing * r_inverse;
  const Eight b = t.step * r_inverse;
  t.turn = (Eight(0.5) * t.eta) * b;
  t.zeta = o.mu - o.beta * r;
  const Eight q = (Eight(1.0 / 6) * t.zeta) * (b * t.step);
  t.more = t.step * (t.turn * ((t.turn + t.turn) - Eight(1.0)) - q);
}
/// A bit for each lane where the error of that step is not far below rounding, or something is not a number.
NOETHER_EIGHT_INLINE unsigned not_final(const EightTrials& t) {
  return exceeding(absolute(t.step), Eight(1e-4) * absolute(t.s)) | exceeding(absolute(t.turn), Eight(2e-5));
}

/// s at the end of an arc over h, by reversion of Kepler's equation at its start, to order 5.
NOETHER_EIGHT_INLINE Eight first_guess(const Eight& h, const Eight& r_inverse, const Eight& eta, const Eight& zeta,
                                       const Eight& beta) {
  const Eight d = h * r_inverse, b = d * r_inverse, p = eta * b, q = zeta * (b * d), u = beta * (d * d), p2 = p * p;
  const Eight third = Eight(10.0) * q + (u - Eight(15.0) * p2);
  const Eight fourth =
      p2 * ((Eight(21.0) * p2 - Eight(21.0) * q) - Eight(3.0) * u) + q * (Eight(2.0) * q + Eight(0.2) * u);
  const Eight low_order = (Eight(0.5) * p2 - Eight(1.0 / 6) * q) - Eight(0.5) * p;
  return d + d * (low_order + Eight(1.0 / 24) * (p * third + fourth));
}

/// Arcs of single lanes by the solver for all cases.
struct ExactArcs {
  unsigned lanes = 0;
  alignas(64) double dx[3][8], dv[3][8], s[8];
};

NOETHER_EIGHT_INLINE void replace(Eight& a, const double* by, unsigned lanes) {
  alignas(64) double own[8];
  store_eight(a, own);
  for (int k = 0; k < 8; ++k) own[k] = (lanes >> k & 1) != 0 ? by[k] : own[k];
  a = load_eight(own);
}
NOETHER_EIGHT_INLINE void replace(Eights& a, const double (*by)[8], unsigned lanes) {
  replace(a.x, by[0], lanes);
  replace(a.y, by[1], lanes);
  replace(a.z, by[2], lanes);
}
NOETHER_EIGHT_INLINE void replace(Eight& a, const Eight& by, unsigned lanes) {
  alignas(64) double other[8];
  store_eight(by, other);
  replace(a, other, lanes);
}

/// Further passes for the lanes of `bad`, the others left as they are; what does not come to an end goes to the exact
/// solver.
[[gnu::noinline, gnu::cold]] void further_passes(const PlanetRows& planets, const PlanetRow& row, EightOrbits& o,
                                                 EightTrials& t, unsigned bad, ExactArcs& exact, ArcReport& report) {
  ++report.second;
  alignas(64) double beta[8], s[8], step[8], h[8];
  store_eight(o.beta, beta);
  store_eight(o.h, h);
  unsigned hopeless = 0;
  for (int pass = 0; bad != 0 && pass < 4; ++pass) {
    store_eight(t.s, s);
    store_eight(t.step + t.more, step);
    bool wide = false;
    for (unsigned k = 0; k < 8; ++k) {
      if ((bad >> k & 1) == 0) continue;
      const double next = s[k] + step[k], size = step[k] < 0 ? -step[k] : step[k], z = beta[k] * next * next;
      if (next * h[k] > 0 && size < 0.25 * (s[k] < 0 ? -s[k] : s[k]) && z < 6 && z > -6) {
        // Half the digits: the last step must not be a fraction of a rounding, which would always be lost.
        const double split = 0x1p29 * next;
        s[k] = (next + split) - split;
        wide = wide || z > widest_series || z < -widest_series;
      } else {
        hopeless |= 1U << k;
      }
    }
    bad &= ~hopeless;
    if (bad == 0) break;
    const Eight next = load_eight(s);
    EightTrials again;
    if (wide) {  // half the argument, then doubled
      again = functions_at(o, Eight(0.5) * next);
      again.g3 = Eight(2.0) * (again.g3 + again.g1 * again.g2);
      again.g2 = Eight(2.0) * (again.g1 * again.g1);
      again.g1 = Eight(2.0) * (again.g0 * again.g1);
      again.g0 = Eight(1.0) - o.beta * again.g2;
      again.s = next;
    } else {
      again = functions_at(o, next);
    }
    look_at(o, again);
    Eight* const to[] = {&t.s, &t.g0, &t.g1, &t.g2, &t.g3, &t.eta, &t.zeta, &t.step, &t.more, &t.turn};
    const Eight* const from[] = {&again.s,   &again.g0,   &again.g1,   &again.g2,   &again.g3,
                                 &again.eta, &again.zeta, &again.step, &again.more, &again.turn};
    for (int k = 0; k < 10; ++k) replace(*to[k], *from[k], bad);
    bad &= not_final(again);
  }
  exact.lanes = bad | hopeless;
  for (int k = 0; k < 8; ++k) {
    if ((exact.lanes >> k & 1) == 0) continue;
    ++report.exact;
    const double x[3] = {row.x[0][k], row.x[1][k], row.x[2][k]}, v[3] = {row.v[0][k], row.v[1][k], row.v[2][k]};
    double dx[3], dv[3];
    if (!planets.exact(x, v, row.mu[k], h[k], dx, dv, &exact.s[k])) report.failed = 8 * (&row - planets.row) + k;
    for (int c = 0; c < 3; ++c) exact.dx[c][k] = dx[c], exact.dv[c][k] = dv[c];
  }
}

/// value += change, with what rounding takes of it where that is kept.
template <bool compensated>
NOETHER_EIGHT_INLINE Eight add_change(const Eight& value, const Eight& change, double* low) {
  if constexpr (compensated) {
    const Eight d = change + load_eight(low), sum = value + d, back = sum - value;
    store_eight((value - (sum - back)) + (d - back), low);
    return sum;
  } else {
    return value + change;
  }
}
template <bool compensated>
NOETHER_EIGHT_INLINE Eights add_change(const Eights& value, const Eights& change, double (*low)[8]) {
  return {add_change<compensated>(value.x, change.x, low[0]), add_change<compensated>(value.y, change.y, low[1]),
          add_change<compensated>(value.z, change.z, low[2])};
}

/// r and 1/r follow from x, always in this way.
NOETHER_EIGHT_INLINE Eight set_distance(const Eights& x, PlanetRow& row) {
  const Eight r = square_root(dot(x, x)), r_inverse = Eight(1.0) / r;
  store_eight(r, row.r);
  store_eight(r_inverse, row.r_inverse);
  return r_inverse;
}

template <bool compensated>
NOETHER_EIGHT_INLINE void advance_arcs(const PlanetRows& planets, PlanetRow& row, const ArcTask& task,
                                       ArcReport& report) {
  const Eights x = load_eights(row.x), v = load_eights(row.v);
  EightOrbits o;
  o.r = load_eight(row.r), o.r_inverse = load_eight(row.r_inverse), o.mu = load_eight(row.mu), o.h = Eight(task.h);
  o.eta = dot(x, v);
  o.beta = (o.mu + o.mu) * o.r_inverse - dot(v, v);
  o.zeta = o.mu - o.beta * o.r;
  const Eight s = task.predicted ? load_eight(row.s) : first_guess(o.h, o.r_inverse, o.eta, o.zeta, o.beta);
  EightTrials t = functions_at(o, s);
  look_at(o, t);
  ExactArcs exact;
  const unsigned bad = not_final(t) | exceeding(absolute(o.beta * (s * s)), Eight(widest_series));
  if (__builtin_expect(bad != 0, 0)) further_passes(planets, row, o, t, bad, exact, report);

  // The last step is made in the functions. Its parts are summed before they meet G: one that is often less than half
  // a rounding of G would always be lost.
  const Eight d = t.step, half = Eight(0.5) * d, third = Eight(1.0 / 3) * d, bent = o.beta * t.g1;
  const Eight g3 = t.g3 + (t.more * (d * t.g1 + t.g2) + d * (half * (third * t.g0 + t.g1) + t.g2));
  const Eight g2 = t.g2 + (t.more * (d * t.g0 + t.g1) + d * (half * (t.g0 - third * bent) + t.g1));
  const Eight g1 = t.g1 + (t.more * (t.g0 - d * bent) + d * (t.g0 - half * (third * (o.beta * t.g0) + bent)));
  const Eight falling = Eight(0.0) - o.mu * g2;
  Eights dx = (falling * o.r_inverse) * x + (o.h - o.mu * g3) * v;
  if (__builtin_expect(exact.lanes != 0, 0)) replace(dx, exact.dx, exact.lanes);
  const Eights new_x = add_change<compensated>(x, dx, row.x_low);
  store_eights(new_x, row.x);
  const Eight r_inverse = set_distance(new_x, row);
  const Eight turning = (Eight(0.0) - o.mu * g1) * o.r_inverse;
  Eights dv = (turning * r_inverse) * x + (falling * r_inverse) * v;
  if (__builtin_expect(exact.lanes != 0, 0)) replace(dv, exact.dv, exact.lanes);
  const Eights new_v = add_change<compensated>(v, dv, row.v_low);
  store_eights(new_v, row.v);
  Eight arc = t.s + (d + t.more);
  if (task.predict) {
    // In an arc back over h at the mirrored point s would miss by -2 eta G2(s), if there were no kick.
    const Eight twice = t.eta + t.zeta * d, eta2 = twice + twice;
    const Eight inverse = Eight(1.0) / (eta2 * g1 + o.r), back = (eta2 * inverse) * g2;
    const Eight turn = (eta2 * t.g0 - o.eta) * (back * inverse);
    Eight next = (t.s + d) - (back * (Eight(0.5) * turn * turn + Eight(0.5) * turn) + back);
    if (__builtin_expect(exact.lanes != 0, 0)) {
      const Eight eta = dot(new_x, new_v), beta = (o.mu + o.mu) * r_inverse - dot(new_v, new_v);
      replace(next, first_guess(o.h, r_inverse, eta, o.mu - beta * load_eight(row.r), beta), exact.lanes);
    }
    store_eight(next, row.s);
  }
  if (__builtin_expect(exact.lanes != 0, 0)) replace(arc, exact.s, exact.lanes);
  store_eight(arc, row.arc);
}

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL

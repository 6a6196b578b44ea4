#pragma once
/// Kepler arcs of eight bodies side by side; for `*_simd.cpp` alone. docs/theory/kepler.md has the formulae.

#include "integrators/planet_row.hpp"
#include "integrators/wide_constant_simd.hpp"
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

#if !defined(NOETHER_SERIES_BITS)
#define NOETHER_SERIES_BITS 53  // tests have fewer of 1/4! and 1/5!, to see that they would notice
#endif
#if !defined(NOETHER_SERIES_LOW)
#define NOETHER_SERIES_LOW 1  // a test has no low parts
#endif

constexpr double one_over_factorial(int n) {
  double f = 1;  // exact up to 22!
  for (int k = 2; k <= n; ++k) f *= k;
  const double split = static_cast<double>(1LL << (53 - NOETHER_SERIES_BITS)) / f;
  return n == 4 || n == 5 ? (1 / f + split) - split : 1 / f;
}
/// What rounding takes from 1/n!. Constants always rounded the same way would make energies drift.
constexpr double one_over_factorial_low(int n) {
  WideConstant f = 1;
  for (int k = 2; k <= n; ++k) f *= k;
  return NOETHER_SERIES_LOW * double(1 / f - 1 / double(f));
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

/// Arcs of single lanes by the solver for all cases, and where they begin.
struct ExactArcs {
  unsigned lanes = 0;
  double dx[3][8], dv[3][8], s[8];
  double x[3][8], v[3][8], x_low[3][8], v_low[3][8];
};

/// Takes the lanes of `lanes` from another one.
[[maybe_unused]] void take_lanes(Eight& a, const Eight& from, unsigned lanes) {
  alignas(64) double own[8], other[8];
  store_eight(a, own);
  store_eight(from, other);
  for (unsigned k = 0; k < 8; ++k) own[k] = (lanes >> k & 1) != 0 ? other[k] : own[k];
  a = load_eight(own);
}

/// Further passes for the lanes of `bad`, the others left as they are. @return lanes that are hopeless
[[gnu::noinline, gnu::cold, maybe_unused]] unsigned further_passes(const EightOrbits& o, EightTrials& t, unsigned bad) {
  alignas(64) double beta[8], s[8], step[8], h[8];
  store_eight(o.beta, beta);
  store_eight(o.h, h);
  unsigned hopeless = 0;
  for (int pass = 0; bad != 0 && pass < 4; ++pass) {
    store_eight(t.s, s);
    store_eight(t.step + t.more, step);
    unsigned wide = 0;
    for (unsigned k = 0; k < 8; ++k) {
      if ((bad >> k & 1) == 0) continue;
      const double next = s[k] + step[k], size = step[k] < 0 ? -step[k] : step[k], z = beta[k] * next * next;
      if (next * h[k] > 0 && size < 0.25 * (s[k] < 0 ? -s[k] : s[k]) && z < 6 && z > -6) {
        // Half the digits: the last step must not be a fraction of a rounding, which would always be lost.
        const double split = 0x1p29 * next;
        s[k] = (next + split) - split;
        if (z > widest_series || z < -widest_series) wide |= 1U << k;
      } else {
        hopeless |= 1U << k;
      }
    }
    bad &= ~hopeless;
    if (bad == 0) break;
    const Eight next = load_eight(s);
    EightTrials again = functions_at(o, next);
    if (wide != 0) {  // half the argument, then doubled
      EightTrials two = functions_at(o, Eight(0.5) * next);
      two.g3 = Eight(2.0) * (two.g3 + two.g1 * two.g2);
      two.g2 = Eight(2.0) * (two.g1 * two.g1);
      two.g1 = Eight(2.0) * (two.g0 * two.g1);
      two.g0 = Eight(1.0) - o.beta * two.g2;
      take_lanes(again.g0, two.g0, wide);
      take_lanes(again.g1, two.g1, wide);
      take_lanes(again.g2, two.g2, wide);
      take_lanes(again.g3, two.g3, wide);
    }
    look_at(o, again);
    Eight* const to[] = {&t.s, &t.g0, &t.g1, &t.g2, &t.g3, &t.eta, &t.zeta, &t.step, &t.more, &t.turn};
    const Eight* const from[] = {&again.s,   &again.g0,   &again.g1,   &again.g2,   &again.g3,
                                 &again.eta, &again.zeta, &again.step, &again.more, &again.turn};
    for (int k = 0; k < 10; ++k) take_lanes(*to[k], *from[k], bad);
    bad &= not_final(again);
  }
  return bad | hopeless;
}

/// What arcs of a row are.
struct Arcs {
  ArcTask task;
  ExactArc exact;
  std::ptrdiff_t first;  ///< number of the row's first body, for reports
};

/// What the solver for all cases says of the arcs of `exact.lanes`, which have not begun to move.
[[gnu::noinline, gnu::cold, maybe_unused]] void solve_exactly(const Arcs& arcs, const ArcRow& row, ExactArcs& exact,
                                                              ArcReport& report) {
  for (int k = 0; k < 8; ++k) {
    if ((exact.lanes >> k & 1) == 0) continue;
    double x[3], v[3], dx[3] = {}, dv[3] = {};  // 0 where there is no body
    exact.s[k] = 0;
    for (int c = 0; c < 3; ++c) x[c] = row.x[c][k], v[c] = row.v[c][k];
    if (row.moves[k] != 0) {
      ++report.exact;
      const bool found = arcs.exact(x, v, row.mu[k], arcs.task.h, dx, dv, &exact.s[k]);
      if (!found && report.failed < 0) report.failed = arcs.first + k;
    }
    for (int c = 0; c < 3; ++c) {
      exact.dx[c][k] = dx[c], exact.dv[c][k] = dv[c], exact.x[c][k] = x[c], exact.v[c][k] = v[c];
      exact.x_low[c][k] = row.x_low[c][k], exact.v_low[c][k] = row.v_low[c][k];
    }
  }
}

/// value += change, with what rounding takes of it where that is kept.
[[maybe_unused]] void add_number(bool compensated, double value, double change, double lost, double& sum, double& low) {
  const double d = compensated ? change + lost : change;
  sum = value + d;
  const double back = sum - value;
  low = compensated ? (value - (sum - back)) + (d - back) : 0;
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
NOETHER_EIGHT_INLINE Eight set_distance(const Eights& x, ArcRow& row) {
  const Eight r = square_root(dot(x, x)), r_inverse = Eight(1.0) / r;
  store_eight(r, row.r);
  store_eight(r_inverse, row.r_inverse);
  return r_inverse;
}

/// Moves the lanes of `exact.lanes` from where they began; the others are where they are to be.
[[gnu::noinline, gnu::cold, maybe_unused]] void place_exactly(const ExactArcs& exact, bool compensated,
                                                              const ArcTask& task, ArcRow& row) {
  for (int k = 0; k < 8; ++k) {
    if ((exact.lanes >> k & 1) == 0) continue;
    for (int c = 0; c < 3; ++c) {
      add_number(compensated, exact.x[c][k], exact.dx[c][k], exact.x_low[c][k], row.x[c][k], row.x_low[c][k]);
      add_number(compensated, exact.v[c][k], exact.dv[c][k], exact.v_low[c][k], row.v[c][k], row.v_low[c][k]);
    }
    row.arc[k] = exact.s[k];
  }
  const Eights x = load_eights(row.x), v = load_eights(row.v);
  set_distance(x, row);  // of the other lanes as it is
  const Eight r_inverse = load_eight(row.r_inverse), mu = load_eight(row.mu);
  const Eight eta = dot(x, v), beta = (mu + mu) * r_inverse - dot(v, v);
  Eight s = load_eight(row.s);
  take_lanes(s, first_guess(Eight(task.h), r_inverse, eta, mu - beta * load_eight(row.r), beta), exact.lanes);
  if (task.predict) store_eight(s, row.s);
}

/// Where the arcs of a row begin.
NOETHER_EIGHT_INLINE EightOrbits orbits_of(const ArcRow& row, const Eights& x, const Eights& v, double h) {
  EightOrbits o;
  o.r = load_eight(row.r), o.r_inverse = load_eight(row.r_inverse), o.mu = load_eight(row.mu), o.h = Eight(h);
  o.eta = dot(x, v);
  o.beta = (o.mu + o.mu) * o.r_inverse - dot(v, v);
  o.zeta = o.mu - o.beta * o.r;
  return o;
}

/// The universal functions at the ends of arcs, and the last trial before.
struct EightEnds {
  EightTrials t;
  Eight g1, g2, g3;

  NOETHER_EIGHT_INLINE Eight s() const { return t.s + (t.step + t.more); }
};

/// @param s  where they are looked for
/// @param exact  the lanes that were left to the solver for all cases
NOETHER_EIGHT_INLINE EightEnds ends_of(const Arcs& arcs, const ArcRow& row, const EightOrbits& o, const Eight& s,
                                       ExactArcs& exact, ArcReport& report) {
  EightEnds e;
  EightTrials& t = e.t;
  t = functions_at(o, s);
  look_at(o, t);
  const unsigned bad = not_final(t) | exceeding(absolute(o.beta * (s * s)), Eight(widest_series));
  if (__builtin_expect(bad != 0, 0)) {
    ++report.second;
    const EightOrbits orbits = o;  // copies, so that those of the common way stay in registers
    EightTrials trials = t;
    exact.lanes = further_passes(orbits, trials, bad);
    t = trials;
    if (exact.lanes != 0) solve_exactly(arcs, row, exact, report);
  }

  // The last step is made in the functions. Its parts are summed before they meet G: one that is often less than half
  // a rounding of G would always be lost.
  const Eight d = t.step, half = Eight(0.5) * d, third = Eight(1.0 / 3) * d, bent = o.beta * t.g1;
  e.g3 = t.g3 + (t.more * (d * t.g1 + t.g2) + d * (half * (third * t.g0 + t.g1) + t.g2));
  e.g2 = t.g2 + (t.more * (d * t.g0 + t.g1) + d * (half * (t.g0 - third * bent) + t.g1));
  e.g1 = t.g1 + (t.more * (t.g0 - d * bent) + d * (t.g0 - half * (third * (o.beta * t.g0) + bent)));
  return e;
}

/// Moves eight bodies along their arcs.
/// @param beside  is called with where they began, x, v, and their ends, when the row holds where they have come to
template <bool compensated, class Beside>
NOETHER_EIGHT_INLINE void advance_arcs(const Arcs& arcs, ArcRow& row, ArcReport& report, const Beside& beside) {
  const ArcTask& task = arcs.task;
  const Eights x = load_eights(row.x), v = load_eights(row.v);
  const EightOrbits o = orbits_of(row, x, v, task.h);
  const Eight s = task.predicted ? load_eight(row.s) : first_guess(o.h, o.r_inverse, o.eta, o.zeta, o.beta);
  ExactArcs exact;
  const EightEnds e = ends_of(arcs, row, o, s, exact, report);
  const EightTrials& t = e.t;
  const Eight falling = Eight(0.0) - o.mu * e.g2;
  const Eights dx = (falling * o.r_inverse) * x + (o.h - o.mu * e.g3) * v;
  const Eights new_x = add_change<compensated>(x, dx, row.x_low);
  store_eights(new_x, row.x);
  const Eight r_inverse = set_distance(new_x, row);
  const Eight turning = (Eight(0.0) - o.mu * e.g1) * o.r_inverse;
  const Eights dv = (turning * r_inverse) * x + (falling * r_inverse) * v;
  store_eights(add_change<compensated>(v, dv, row.v_low), row.v);
  store_eight(e.s(), row.arc);
  if (task.predict) {
    // In an arc back over h at the mirrored point s would miss by -2 eta G2(s), if there were no kick.
    const Eight d = t.step, last = t.eta + t.zeta * d, twice = last + last;
    const Eight inverse = Eight(1.0) / (twice * e.g1 + o.r), back = (twice * inverse) * e.g2;
    const Eight turn = (twice * t.g0 - o.eta) * (back * inverse);
    store_eight((t.s + d) - (back * (Eight(0.5) * turn * turn + Eight(0.5) * turn) + back), row.s);
  }
  if (__builtin_expect(exact.lanes != 0, 0)) place_exactly(exact, compensated, task, row);
  beside(o, x, v, e, exact.lanes);
}
template <bool compensated> NOETHER_EIGHT_INLINE void advance_arcs(const Arcs& arcs, ArcRow& row, ArcReport& report) {
  advance_arcs<compensated>(arcs, row, report, [](const auto&...) {});
}

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL

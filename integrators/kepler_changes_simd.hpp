#pragma once
/// Small changes of the starts of Kepler arcs and what becomes of them, eight side by side; for `*_simd.cpp` alone.

#include "integrators/kepler_simd.hpp"
#include "integrators/planet_systems_row.hpp"

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

/// a b + c, rounded once where the level has such an operation: small changes need not have the same bits at every
/// level.
NOETHER_EIGHT_INLINE Eight fused(const Eight& a, const Eight& b, const Eight& c) {
#if defined(__AVX512F__) && NOETHER_EIGHT_REGISTERS == 1
  return eight_of([&](int k) { return EightRegister(_mm512_fmadd_pd(a.r[k], b.r[k], c.r[k])); });
#elif defined(__FMA__) && NOETHER_EIGHT_REGISTERS == 2
  return eight_of([&](int k) { return EightRegister(_mm256_fmadd_pd(a.r[k], b.r[k], c.r[k])); });
#else
  return a * b + c;
#endif
}
/// c - a b.
NOETHER_EIGHT_INLINE Eight less(const Eight& c, const Eight& a, const Eight& b) {
#if defined(__AVX512F__) && NOETHER_EIGHT_REGISTERS == 1
  return eight_of([&](int k) { return EightRegister(_mm512_fnmadd_pd(a.r[k], b.r[k], c.r[k])); });
#elif defined(__FMA__) && NOETHER_EIGHT_REGISTERS == 2
  return eight_of([&](int k) { return EightRegister(_mm256_fnmadd_pd(a.r[k], b.r[k], c.r[k])); });
#else
  return c - a * b;
#endif
}
NOETHER_EIGHT_INLINE Eights fused(const Eight& a, const Eights& b, const Eights& c) {
  return {fused(a, b.x, c.x), fused(a, b.y, c.y), fused(a, b.z, c.z)};
}
NOETHER_EIGHT_INLINE Eights less(const Eights& c, const Eight& a, const Eights& b) {
  return {less(c.x, a, b.x), less(c.y, a, b.y), less(c.z, a, b.z)};
}
/// a . b + c
NOETHER_EIGHT_INLINE Eight fused_dot(const Eights& a, const Eights& b, const Eight& c) {
  return fused(a.x, b.x, fused(a.y, b.y, fused(a.z, b.z, c)));
}
NOETHER_EIGHT_INLINE Eight fused_dot(const Eights& a, const Eights& b) {
  return fused(a.x, b.x, fused(a.y, b.y, a.z * b.z));
}

/// c_n(z) = sum of (-1)^k/(2 k + n)! z^k, terms 2 k to `terms` - 1.
template <int n, int terms, int k = 0> NOETHER_EIGHT_INLINE Eight change_series(const Eight& z, const Eight& z2) {
  const Eight pair = fused(Eight(-one_over_factorial(2 * k + 2 + n)), z, Eight(one_over_factorial(2 * k + n)));
  if constexpr (k + 2 >= terms) {
    return pair;
  } else {
    return fused(z2, change_series<n, terms, k + 2>(z, z2), pair);
  }
}

/// G_0 to G_5 at s.
struct EightFunctions {
  Eight g0, g1, g2, g3, g4, g5;
};

/// The derivative of arcs by their starts, along a direction: the formulae of `KeplerTangent` in the slopes that r, eta
/// and beta of the start have there.
/// @source ReinTamayo2015
struct EightTurns {
  Eights x, v, x1;
  Eight r_inverse, r1_inverse, beta_by_r, g0, g1, g2;
  Eight g1_beta, g2_beta, g3_beta, s_r, s_eta, s_beta;
  Eight mu, falling, g, turning, falling1;  ///< f - 1, g, f', g' - 1

  /// @param inverse  1/|x| at the ends of the arcs
  NOETHER_EIGHT_INLINE EightTurns(const EightOrbits& o, const Eights& at, const Eights& speed, const Eight& s,
                                  const EightFunctions& e, const Eight& inverse)
      : x(at), v(speed), r_inverse(o.r_inverse), r1_inverse(inverse), g0(e.g0), g1(e.g1), g2(e.g2), mu(o.mu) {
    const Eight half(0.5), half_s = half * s;
    g1_beta = less(half * e.g3, half_s, g2);
    g2_beta = less(e.g4, half_s, e.g3);
    g3_beta = less(Eight(1.5) * e.g5, half_s, e.g4);
    s_r = g1 * r1_inverse;
    s_eta = g2 * r1_inverse;
    s_beta = less(less(o.r * e.g3, o.eta, g2_beta), o.zeta, g3_beta) * r1_inverse;
    const Eight pull = o.mu * r_inverse;
    beta_by_r = pull * r_inverse;
    falling = Eight(0.0) - pull * g2;
    g = less(o.h, o.mu, e.g3);
    turning = Eight(0.0) - (pull * r1_inverse) * g1;
    falling1 = Eight(0.0) - (o.mu * r1_inverse) * g2;
    x1 = fused(falling, x, fused(g, v, x));
  }
  /// What a change (a, b) of the start by position and velocity becomes.
  NOETHER_EIGHT_INLINE void turn(Eights& a, Eights& b) const {
    const Eight of_r = fused_dot(x, a) * r_inverse, of_eta = fused_dot(x, b, fused_dot(v, a));
    const Eight half_beta = fused(beta_by_r, of_r, fused_dot(v, b)), of_beta = Eight(-2.0) * half_beta;
    const Eight of_s = less(less(s_beta * of_beta, s_r, of_r), s_eta, of_eta);
    const Eight of_g1 = fused(g0, of_s, g1_beta * of_beta), of_g2 = fused(g1, of_s, g2_beta * of_beta);
    const Eight of_g3 = fused(g2, of_s, g3_beta * of_beta), shrinks = r_inverse * of_r;
    const Eight pull = mu * r_inverse, pull1 = mu * r1_inverse;
    const Eight of_f = pull * (g2 * shrinks - of_g2), of_g = Eight(0.0) - mu * of_g3;
    const Eights moved = a + fused(falling, a, fused(g, b, fused(of_f, x, of_g * v)));
    const Eight shrinks1 = (fused_dot(x1, moved) * r1_inverse) * r1_inverse;
    const Eight of_turning = (pull * r1_inverse) * (g1 * (shrinks + shrinks1) - of_g1);
    const Eight of_falling1 = pull1 * (g2 * shrinks1 - of_g2);
    b = b + fused(turning, a, fused(falling1, b, fused(of_turning, x, of_falling1 * v)));
    a = moved;
  }
};

/// Of arcs as `ends_of` finds them.
NOETHER_EIGHT_INLINE EightFunctions functions_of(const EightOrbits& o, const EightEnds& e) {
  const Eight s = e.s(), s2 = s * s, z = o.beta * s2, z2 = z * z, s4 = s2 * s2;
  return {less(Eight(1.0), o.beta, e.g2),        e.g1, e.g2, e.g3, s4 * change_series<4, 10>(z, z2),
          (s4 * s) * change_series<5, 10>(z, z2)};
}

/// The universal functions where arcs end, by one step of Kepler's equation, of second order, from near them.
struct EightLooks {
  Eight s, inverse;  ///< universal variable, and 1/|x|
  EightFunctions g;
  unsigned bad;  ///< lanes that were not near enough
};
NOETHER_EIGHT_INLINE EightLooks look_from(const EightOrbits& o, const Eight& near) {
  EightLooks look;
  const Eight s = near, s2 = s * s, z = o.beta * s2, z2 = z * z, s3 = s2 * s;
  EightFunctions g;
  g.g4 = (s2 * s2) * change_series<4, 8>(z, z2);
  g.g5 = (s3 * s2) * change_series<5, 8>(z, z2);
  g.g3 = less(Eight(1.0 / 6) * s3, o.beta, g.g5);
  g.g2 = less(Eight(0.5) * s2, o.beta, g.g4);
  g.g1 = less(s, o.beta, g.g3);
  g.g0 = less(Eight(1.0), o.beta, g.g2);
  const Eight r = fused(o.eta, g.g1, fused(o.zeta, g.g2, o.r));
  const Eight missing = less(less(less(o.h, o.r, s), o.eta, g.g2), o.zeta, g.g3);
  const Eight r_inverse = Eight(1.0) / r, by_newton = missing * r_inverse;
  const Eight turn = (Eight(0.5) * fused(o.eta, g.g0, o.zeta * g.g1)) * (by_newton * r_inverse);
  const Eight d = less(by_newton, by_newton, turn), half = Eight(0.5) * d, bent = o.beta * g.g1;
  look.bad = exceeding(absolute(d), Eight(1e-5) * absolute(s)) | exceeding(absolute(z), Eight(0.7));
  look.s = s + d;
  look.g.g5 = fused(d, fused(half, g.g3, g.g4), g.g5);
  look.g.g4 = fused(d, fused(half, g.g2, g.g3), g.g4);
  look.g.g3 = fused(d, fused(half, g.g1, g.g2), g.g3);
  look.g.g2 = fused(d, fused(half, g.g0, g.g1), g.g2);
  look.g.g1 = fused(d, less(g.g0, half, bent), g.g1);
  look.g.g0 = less(Eight(1.0), o.beta, look.g.g2);
  look.inverse = Eight(1.0) / fused(o.eta, look.g.g1, fused(o.zeta, look.g.g2, o.r));
  return look;
}

/// What `ExactTurn` says, of single lanes of a row.
struct ExactTurns {
  ExactTurns(ExactTurn by, unsigned of, double over) : turn(by), lanes(of), h(over) {}
  ExactTurn turn;
  unsigned lanes;
  double h;
  double x[3][8], v[3][8], mu[8], s[8];
};

[[gnu::noinline, gnu::cold, maybe_unused]] void turn_exactly(const ExactTurns& exact, Eights& a, Eights& b) {
  alignas(64) double u[3][8], w[3][8];
  store_eights(a, u);
  store_eights(b, w);
  for (int k = 0; k < 8; ++k) {
    if ((exact.lanes >> k & 1) == 0) continue;
    double start[6], change[6];
    for (int c = 0; c < 3; ++c) {
      start[c] = exact.x[c][k], start[c + 3] = exact.v[c][k];
      change[c] = u[c][k], change[c + 3] = w[c][k];
    }
    exact.turn(start, exact.mu[k], exact.h, exact.s[k], change);
    for (int c = 0; c < 3; ++c) u[c][k] = change[c], w[c][k] = change[c + 3];
  }
  a = load_eights(u);
  b = load_eights(w);
}

[[maybe_unused]] void take_lanes(Eights& a, const Eights& from, unsigned lanes) {
  take_lanes(a.x, from.x, lanes);
  take_lanes(a.y, from.y, lanes);
  take_lanes(a.z, from.z, lanes);
}

/// Turns a change where some lanes are left to `ExactTurn`.
[[gnu::noinline, gnu::cold, maybe_unused]] void turn_with(const EightTurns& turns, const ExactTurns& exact, Eights& a,
                                                          Eights& b) {
  Eights u = a, w = b;
  turn_exactly(exact, u, w);
  turns.turn(a, b);
  take_lanes(a, u, exact.lanes);
  take_lanes(b, w, exact.lanes);
}

/// The lanes of arcs whose ends the series do not reach, or that were left to the solver for all cases.
NOETHER_EIGHT_INLINE unsigned beyond_series(const EightOrbits& o, const EightEnds& e, unsigned exact) {
  const Eight s = e.s();
  return exact | exceeding(absolute(o.beta * (s * s)), Eight(widest_series));
}

/// What those lanes have to say. @param s  universal variables of the arcs
[[gnu::noinline, gnu::cold, maybe_unused]] void set_exact(ExactTurns& exact, const ArcRow& row, const Eights& x,
                                                          const Eights& v, const Eight& s) {
  alignas(64) double lines[7][8];
  store_eights(x, lines);
  store_eights(v, lines + 3);
  store_eight(s, lines[6]);
  for (int k = 0; k < 8; ++k) {
    for (int c = 0; c < 3; ++c) exact.x[c][k] = lines[c][k], exact.v[c][k] = lines[c + 3][k];
    exact.mu[k] = row.mu[k];
    exact.s[k] = lines[6][k];
  }
}

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL

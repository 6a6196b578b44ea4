#pragma once
/// Kepler arcs and their derivatives by the start, eight side by side: what `KeplerTangent` computes one by one. For
/// `*_simd.cpp` alone.

#include "numbers/eight_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

/// c_n(z) = sum of (-1)^k / (2 k + n)! z^k for |z| up to 1: `low` is what rounding takes from the first coefficients,
/// which would be a drift.
struct TangentSeries {
  static constexpr int terms = 10;
  double high[terms] = {}, low[3] = {};

  constexpr explicit TangentSeries(int n) {
    long double term = 1;
    for (int j = 2; j <= n; ++j) term /= static_cast<long double>(j);
    for (int k = 0; k < terms; ++k) {
      high[k] = static_cast<double>(term);
      if (k < 3) low[k] = static_cast<double>(term - static_cast<long double>(high[k]));
      const int j = 2 * k + n;
      term /= -static_cast<long double>(j + 1) * static_cast<long double>(j + 2);
    }
  }
  NOETHER_EIGHT_INLINE Eight at(const Eight& z, const Eight& z2) const {
    const auto pair = [&](int k) { return Eight(high[k]) + Eight(high[k + 1]) * z; };
    const auto both = [&](int k, const Eight& rest) { return Eight(high[k]) + (Eight(low[k]) + z * rest); };
    return both(0, both(1, both(2, pair(3) + z2 * (pair(5) + z2 * (pair(7) + z2 * Eight(high[9]))))));
  }
};
constexpr TangentSeries fourth_series(4), fifth_series(5);
constexpr double sixth = 1.0 / 6, sixth_low = static_cast<double>(1.0L / 6 - static_cast<long double>(sixth));

/// G_0 to G_5 at s, with one doubling: for |beta s^2| up to 4.
struct EightSixFunctions {
  Eight g0, g1, g2, g3, g4, g5;

  NOETHER_EIGHT_INLINE EightSixFunctions(const Eight& at0, const Eight& at1, const Eight& at2, const Eight& at3,
                                         const Eight& at4, const Eight& at5)
      : g0(at0), g1(at1), g2(at2), g3(at3), g4(at4), g5(at5) {}
  NOETHER_EIGHT_INLINE EightSixFunctions(const Eight& beta, const Eight& s) {
    const Eight part = s * Eight(0.5), square = part * part, z = beta * square, z2 = z * z, third = part * square;
    g4 = square * square * fourth_series.at(z, z2);
    g5 = third * square * fifth_series.at(z, z2);
    g2 = square * Eight(0.5) - beta * g4;
    g3 = third * Eight(sixth) + (third * Eight(sixth_low) - beta * g5);
    g1 = part - beta * g3;
    g0 = Eight(1.0) - beta * g2;
    g5 = Eight(2.0) * (g5 + part * g4 + g2 * g3);
    g4 = Eight(2.0) * (part + g1) * g3;
    g3 = Eight(2.0) * (g3 + g1 * g2);
    g2 = Eight(2.0) * g1 * g1;
    g1 = Eight(2.0) * g0 * g1;
    g0 = Eight(1.0) - beta * g2;
  }
  /// The same functions at s + d, to the second order in d.
  NOETHER_EIGHT_INLINE void shift(const Eight& beta, const Eight& d) {
    const Eight half = Eight(0.5) * d, before = beta * g1;
    g5 = g5 + d * (g4 + half * g3);
    g4 = g4 + d * (g3 + half * g2);
    g3 = g3 + d * (g2 + half * g1);
    g2 = g2 + d * (g1 + half * g0);
    g1 = g1 + d * (g0 - half * before);
    g0 = g0 - d * (before + half * (beta * g0));
  }
};

/// Where arcs begin: t(s) = r s + eta G2 + zeta G3.
struct EightStarts {
  Eight mu, r, r_inverse, eta, zeta, beta;
};

/// The step of s to the root of t(s) = tau, by reversion to the fourth order, from where `missing` is left.
NOETHER_EIGHT_INLINE Eight reversion(const Eight& missing, const Eight& r_inverse, const Eight& eta, const Eight& zeta,
                                     const Eight& beta) {
  const Eight d = missing * r_inverse, b = d * r_inverse, p = eta * b, q = zeta * (d * b), p2 = p * p;
  const Eight third = (Eight(10.0) * q - Eight(15.0) * p2) + beta * (d * d);
  const Eight first = p * (third * Eight(1.0 / 24) - Eight(0.5));
  return d + d * (first + (p2 * Eight(0.5) - q * Eight(sixth)));
}

/// f or f', g or g', and their derivatives by x0 and v0 as multiples of x0 and v0:
///     df/dx0 = f_x x0 + f_eta v0,   df/dv0 = f_eta x0 + f_v v0,   g likewise
struct EightHalf {
  Eight f, g, f_x, f_eta, f_v, g_x, g_eta, g_v;

  /// What a change of the start by (x, v) does to the end.
  NOETHER_EIGHT_INLINE Eights turned(const Eights& x, const Eights& v, const Eights& x0, const Eights& v0) const {
    const Eight xx = dot(x0, x), mixed = dot(v0, x) + dot(x0, v), vv = dot(v0, v);
    const Eight of_f = f_x * xx + f_eta * mixed + f_v * vv, of_g = g_x * xx + g_eta * mixed + g_v * vv;
    return (f * x + g * v) + (of_f * x0 + of_g * v0);
  }
};

/// Derivatives by r0, by eta0 = x0 . v0 and by beta, which are what an arc depends on beside mu and its time.
struct EightSlopes {
  Eight r, eta, beta;
};

/// The derivative of arcs by their starts, at s.
struct EightTangents {
  const EightStarts& a;
  const EightSixFunctions& g;
  Eight t, r, r_inverse, g2_beta, g3_beta, minus_mu, by_r, twice;
  Eight bend;  ///< f - 1
  EightSlopes s_by;

  NOETHER_EIGHT_INLINE EightTangents(const EightStarts& start, const EightSixFunctions& at, const Eight& s,
                                     const Eight& time)
      : a(start), g(at), t(time) {
    const Eight half(0.5);
    r = a.r + (a.eta * g.g1 + a.zeta * g.g2);
    r_inverse = Eight(1.0) / r;
    g2_beta = g.g4 - half * (s * g.g3);
    g3_beta = half * (Eight(3.0) * g.g5 - s * g.g4);
    s_by.r = (Eight(0.0) - g.g1) * r_inverse;
    s_by.eta = (Eight(0.0) - g.g2) * r_inverse;
    s_by.beta = (a.r * g.g3 - a.eta * g2_beta - a.zeta * g3_beta) * r_inverse;
    minus_mu = Eight(0.0) - a.mu;
    by_r = minus_mu * a.r_inverse;
    bend = by_r * g.g2;
    twice = (a.mu + a.mu) * (a.r_inverse * a.r_inverse);
  }
  NOETHER_EIGHT_INLINE EightSlopes by(const Eight& along_s, const Eight& by_beta) const {
    return {along_s * s_by.r, along_s * s_by.eta, along_s * s_by.beta + by_beta};
  }
  NOETHER_EIGHT_INLINE void put(const EightSlopes& slopes, Eight& x, Eight& of_eta, Eight& v) const {
    x = by_r * (slopes.r - twice * slopes.beta);
    of_eta = minus_mu * slopes.eta;
    v = (a.mu + a.mu) * slopes.beta;
  }
  /// f = 1 - mu G2 / r0 and g = t - mu G3.
  NOETHER_EIGHT_INLINE EightHalf upper() const {
    EightHalf h;
    const Eight part = g.g2 * a.r_inverse;
    h.f = Eight(1.0) + bend;
    h.g = t - a.mu * g.g3;
    EightSlopes of_f = by(g.g1 * a.r_inverse, g2_beta * a.r_inverse);
    of_f.r = of_f.r - part * a.r_inverse;
    put(of_f, h.f_x, h.f_eta, h.f_v);
    put(by(g.g2, g3_beta), h.g_x, h.g_eta, h.g_v);
    return h;
  }
  /// f' = -mu G1 / (r r0) and g' = 1 - mu G2 / r.
  NOETHER_EIGHT_INLINE EightHalf lower(const Eight& s) const {
    EightHalf h;
    const Eight half(0.5), eta = a.eta * g.g0 + a.zeta * g.g1, g1_beta = half * (g.g3 - s * g.g2);
    EightSlopes r_by = by(eta, a.eta * g1_beta + a.zeta * g2_beta - a.r * g.g2);
    r_by.r = r_by.r + g.g0;
    r_by.eta = r_by.eta + g.g1;
    const Eight both = r_inverse * a.r_inverse, falls = g.g1 * both, part = g.g2 * r_inverse;
    h.f = minus_mu * falls;
    h.g = Eight(1.0) + minus_mu * part;
    const EightSlopes g1_by = by(g.g0, g1_beta), g2_by = by(g.g1, g2_beta);
    put({(g1_by.r - falls * (r + a.r * r_by.r)) * both, (g1_by.eta - falls * (a.r * r_by.eta)) * both,
         (g1_by.beta - falls * (a.r * r_by.beta)) * both},
        h.f_x, h.f_eta, h.f_v);
    put({(g2_by.r - part * r_by.r) * r_inverse, (g2_by.eta - part * r_by.eta) * r_inverse,
         (g2_by.beta - part * r_by.beta) * r_inverse},
        h.g_x, h.g_eta, h.g_v);
    return h;
  }
};

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL

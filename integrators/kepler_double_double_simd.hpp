#pragma once
/// Kepler arcs of eight bodies side by side in two words. For `*_simd.cpp` alone.

#include "integrators/double_double_simd.hpp"
#include "integrators/kepler_tangent_simd.hpp"
#include "integrators/wide_constant_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

/// c_n(z) = sum of (-1)^k / (2 k + n)! z^k, right to 2e-27 for |z| up to 4 and to 1e-31 up to 1. Only the first terms
/// are summed in two words: what the rounding of the others leaves is smaller than that.
template <int n> struct WideSeries {
  static constexpr int wide = 8, all = 16;
  double high[all] = {}, low[wide] = {};

  constexpr WideSeries() {
    WideConstant term = 1;
    for (int j = 2; j <= n; ++j) term /= j;
    for (int k = 0; k < all; ++k) {
      high[k] = static_cast<double>(term);
      if (k < wide) low[k] = static_cast<double>(term - high[k]);
      term /= -(2 * k + n + 1) * (2 * k + n + 2);
    }
  }
  NOETHER_EIGHT_INLINE EightWide at(const EightWide& z) const {
    const Eight z2 = z.high * z.high;
    const auto pair = [&](int k) { return Eight(high[k]) + Eight(high[k + 1]) * z.high; };
    const Eight rest = pair(8) + z2 * (pair(10) + z2 * (pair(12) + z2 * pair(14)));
    EightWide sum{rest, Eight(0.0)};
    for (int k = wide - 1; k >= 0; --k) {
      const EightWide p = z * sum, s = ordered_sum(Eight(high[k]), p.high);
      sum = {s.high, s.low + (p.low + Eight(low[k]))};
    }
    return sum;
  }
};
constexpr WideSeries<2> wide_second;
constexpr WideSeries<3> wide_third;

/// Arcs of eight bodies, or what is known of them.
struct EightWideArcs {
  EightWides x, v;  ///< at the start
  EightWide mu;
  EightWide r, r_inverse, eta, zeta, beta, v2;

  NOETHER_EIGHT_INLINE EightWideArcs(const EightWides& position, const EightWides& velocity, const EightWide& mass)
      : x(position), v(velocity), mu(mass) {
    r = square_root(dot(x, x));
    r_inverse = reciprocal(r);
    eta = dot(x, v);
    v2 = dot(v, v);
    beta = scaled(Eight(2.0), mu * r_inverse) - v2;
    zeta = r * v2 - mu;
  }
  NOETHER_EIGHT_INLINE EightStarts in_doubles() const {
    return {mu.high, r.high, r_inverse.high, eta.high, zeta.high, beta.high};
  }
  /// A bit for each lane that is not between these bounds, beyond which products may underflow or overflow.
  NOETHER_EIGHT_INLINE unsigned extreme() const {
    const Eight most(1e15), least(1e-100);
    unsigned lanes = exceeding(r.high, most) | exceeding(Eight(1e-15), r.high) | exceeding(v2.high, Eight(1e30)) |
                     exceeding(mu.high, Eight(1e30)) | exceeding(least, mu.high);
    const Eight* const parts[] = {&x.x.high, &x.y.high, &x.z.high, &v.x.high, &v.y.high, &v.z.high};
    for (const Eight* part : parts) {
      const Eight size = absolute(*part);
      lanes |= exceeding(size, Eight(0.0)) & exceeding(least, size);
    }
    return lanes;
  }
};

/// The end of arcs, as increments: dx = f x + g v, dv = f' x + g' v.
struct EightWideEnds {
  EightWide f, g, f_dot, g_dot;
  unsigned missed;  ///< a bit for each lane where s was not good enough, or too long
};

/// Arcs over h. @param s  right to some roundings of doubles: one step from there is made
NOETHER_EIGHT_INLINE EightWideEnds wide_ends(const EightWideArcs& a, const Eight& h, const Eight& s) {
  const EightWide s2 = exact_product(s, s), z = a.beta * s2;
  EightWide g2 = s2 * wide_second.at(z), g3 = (s * s2) * wide_third.at(z);
  const EightWide bend = a.beta * g3, fall = a.beta * g2;
  EightWide g1 = exact_sum(s, negative(bend.high)), g0 = exact_sum(Eight(1.0), negative(fall.high));
  g1.low = g1.low - bend.low;
  g0.low = g0.low - fall.low;
  const EightWide linear = s * a.r;
  const EightWide missing =
      ((exact_sum(h, negative(linear.high)) - EightWide{Eight(0.0), linear.low}) - (a.eta * g2 + a.zeta * g3));
  EightWide end = a.r + (a.eta * g1 + a.zeta * g2);
  const Eight turn = a.eta.high * g0.high + a.zeta.high * g1.high, over = Eight(1.0) / end.high, half(0.5);
  const Eight first = missing.high * over, d = first - half * turn * over * first * first;
  // The rest of the step is a rounding error of doubles long: its products need no low words.
  const Eight slight(0x1p-46);
  EightWideEnds ends;
  ends.missed = exceeding(absolute(d), slight * absolute(s)) | exceeding(absolute(turn * d), slight * end.high) |
                exceeding(absolute(z.high), Eight(4.0));
  g3 = ordered_sum(g3.high, g3.low + d * (g2.high + half * d * g1.high));
  g2 = ordered_sum(g2.high, g2.low + d * (g1.high + half * d * g0.high));
  g1 = ordered_sum(g1.high, g1.low + d * (g0.high - half * d * (a.beta.high * g1.high)));
  end = ordered_sum(end.high, end.low + d * (turn + half * d * (a.mu.high - a.beta.high * end.high)));
  const EightWide toward = -(a.mu * reciprocal(end)), delay = a.mu * g3;
  ends.f = -((a.mu * a.r_inverse) * g2);
  ends.g = exact_sum(h, negative(delay.high)) - EightWide{Eight(0.0), delay.low};
  ends.f_dot = toward * (g1 * a.r_inverse);
  ends.g_dot = toward * g2;
  return ends;
}

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL

#include "integrators/methods/encke_words_simd.hpp"

#include "integrators/kepler_double_double_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

NOETHER_EIGHT_INLINE EightWide same_words(const EightWords& one, int lane) { return {one[0][lane], one[1][lane]}; }

void relate(EnckeEight* eights, std::ptrdiff_t n, EightWords& primary) {
  const EightWide center = exact_sum(load_eight(primary[0]), load_eight(primary[1]));
  store_wide(center, primary);
  for (std::ptrdiff_t m = 0; m < n; ++m) {
    EnckeEight& eight = eights[m];
    for (int k = 0; k < 6; ++k) {
      const EightWide at = exact_sum(load_eight(eight.at[k][0]), load_eight(eight.at[k][1]));
      store_wide(at, eight.at[k]);
      store_wide(at - same_words(primary, k), eight.own[k]);
    }
  }
}

void sum(const EnckeBody& body, const EightWords& weights, EnckeEight& eight, std::ptrdiff_t lane) {
  const Eight b = load_eight(weights[0]), b_low = load_eight(weights[1]);
  for (int k = 0; k < 6; ++k) {
    const Eight rate = load_eight(body.rate[k]);
    eight.sums[k][0][lane] = sum_of_lanes(b * rate).r[0][0];
    eight.sums[k][1][lane] = sum_of_lanes(b_low * rate).r[0][0];
  }
}

/// Departures at the end, from one word of the sums.
NOETHER_EIGHT_INLINE void depart(const EnckeEight& eight, int word, const EightHalf (&halves)[2], const Eights& x0,
                                 const Eights& v0, const Eight& h, Eights (&out)[2]) {
  const auto row = [&](int k) { return load_eight(eight.sums[k][word]); };
  const Eights x{row(0), row(1), row(2)}, v{row(3), row(4), row(5)};
  for (int half = 0; half < 2; ++half) out[half] = h * halves[half].turned(x, v, x0, v0);
}

unsigned advance(EnckeEight& eight, double length, double tau) {
  const Eight h(length);
  const EightWideArcs arcs(load_wides(eight.own), load_wides(eight.own + 3), load_wide(eight.mu));
  const EightStarts a = arcs.in_doubles();
  const Eight last_r = load_eight(eight.last_r);
  const Eight guess = load_eight(eight.last_s) + reversion(Eight(length - tau), Eight(1.0) / last_r,
                                                           load_eight(eight.last_eta), a.mu - a.beta * last_r, a.beta);
  EightSixFunctions g(a.beta, guess);
  const Eight missing = (h - a.r * guess) - (a.eta * g.g2 + a.zeta * g.g3);
  const Eight over = Eight(1.0) / (a.r + (a.eta * g.g1 + a.zeta * g.g2)), first = missing * over;
  const Eight d = first - Eight(0.5) * (a.eta * g.g0 + a.zeta * g.g1) * over * first * first;
  g.shift(a.beta, d);
  const Eight s = guess + d;
  const EightWideEnds ends = wide_ends(arcs, h, s);

  const EightTangents tangents(a, g, s, h);
  const EightHalf halves[2] = {tangents.upper(), tangents.lower(s)};
  Eights away[2], away_low[2];
  depart(eight, 0, halves, high_words(arcs.x), high_words(arcs.v), h, away);
  depart(eight, 1, halves, high_words(arcs.x), high_words(arcs.v), h, away_low);
  const auto move = [&](int k, const EightWide& x, const EightWide& v, const Eight& far, const Eight& low,
                        const EightWide& by_x, const EightWide& by_v) {
    store_wide((by_x * x + by_v * v) + EightWide{far, low}, eight.moved[k]);
  };
  move(0, arcs.x.x, arcs.v.x, away[0].x, away_low[0].x, ends.f, ends.g);
  move(1, arcs.x.y, arcs.v.y, away[0].y, away_low[0].y, ends.f, ends.g);
  move(2, arcs.x.z, arcs.v.z, away[0].z, away_low[0].z, ends.f, ends.g);
  move(3, arcs.x.x, arcs.v.x, away[1].x, away_low[1].x, ends.f_dot, ends.g_dot);
  move(4, arcs.x.y, arcs.v.y, away[1].y, away_low[1].y, ends.f_dot, ends.g_dot);
  move(5, arcs.x.z, arcs.v.z, away[1].z, away_low[1].z, ends.f_dot, ends.g_dot);
  return ends.missed | arcs.extreme() | exceeding(absolute(d), Eight(0x1p-20) * absolute(s));
}

/// The sum of all lanes in each.
NOETHER_EIGHT_INLINE EightWide sum_of_lanes(const EightWide& a) {
  const EightWide four = a + EightWide{rotate<4>(a.high), rotate<4>(a.low)};
  const EightWide two = four + EightWide{rotate<2>(four.high), rotate<2>(four.low)};
  return two + EightWide{rotate<1>(two.high), rotate<1>(two.low)};
}

void place(EnckeEight* eights, std::ptrdiff_t n, EightWords& primary, const double* push, double h) {
  alignas(64) EightWords change = {}, speed = {};
  for (int k = 0; k < 6; ++k) {
    EightWide sum{Eight(0.0), Eight(0.0)};
    for (std::ptrdiff_t m = 0; m < n; ++m) {
      const EightWide moved = load_wide(eights[m].moved[k]);
      const EightWide left = k < 3 ? Eight(h) * load_wide(eights[m].own[k < 3 ? k + 3 : 0]) - moved : -moved;
      sum = sum + load_wide(eights[m].share) * left;
    }
    const EightWide whole = sum_of_lanes(sum);
    for (int word = 0; word < 2; ++word) {
      change[word][k] = (word == 0 ? whole.high : whole.low).r[0][0];
      if (k < 3) speed[word][k] = primary[word][k + 3];
    }
  }
  const EightWide moved = (load_wide(change) + Eight(h) * load_wide(speed)) + load_eight(push);
  store_wide(moved, change);
  store_wide(load_wide(primary) + moved, primary);
  for (std::ptrdiff_t m = 0; m < n; ++m) {
    for (int k = 0; k < 6; ++k) {
      const EightWide along = load_wide(eights[m].moved[k]) + same_words(change, k);
      store_wide(load_wide(eights[m].at[k]) + along, eights[m].at[k]);
    }
  }
}

}  // namespace

extern const EnckeWordKernels encke_word_kernels;
const EnckeWordKernels encke_word_kernels{relate, sum, advance, place};

}  // namespace noether::NOETHER_SIMD_LEVEL

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

void sum(const EnckeBody* const* bodies, const EnckeWeights& weights, EnckeEight& eight) {
  const Eight b = load_eight(weights.end[0]), b_low = load_eight(weights.end[1]), last = load_eight(weights.last);
  for (int k = 0; k < 6; ++k) {
    const auto rate = [&](int m) { return load_eight(bodies[m]->rate[k]); };
    store_eight(sums_of_lanes([&](int m) { return b * rate(m); }), eight.sums[k][0]);
    store_eight(sums_of_lanes([&](int m) { return b_low * rate(m); }), eight.sums[k][1]);
  }
  Eight last2(0.0);
  for (int k = 0; k < 3; ++k) {
    const Eight one = sums_of_lanes([&](int m) { return last * load_eight(bodies[m]->perturbation[k]); });
    last2 = last2 + one * one;
  }
  const auto larger = [](const Eight& x, const Eight& y) {
    return eight_of([&](int k) { return x.r[k] > y.r[k] ? x.r[k] : y.r[k]; });
  };
  const auto size2 = [&](int m) {
    const Eights p = load_eights(bodies[m]->perturbation);
    return dot(p, p);
  };
  store_eight(last2, eight.last2);
  store_eight(joined_lanes(size2, larger), eight.largest2);
  store_eight(joined_lanes([&](int m) { return load_eight(bodies[m]->inverse_r2); }, larger), eight.nearest);
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

void place(EnckeEight* eights, std::ptrdiff_t n, EightWords& primary, const double* push, double h) {
  alignas(64) EightWords change, speed = {};
  EightWide left[8];
  for (int k = 0; k < 8; ++k) left[k] = {Eight(0.0), Eight(0.0)};
  for (std::ptrdiff_t m = 0; m < n; ++m) {
    const EnckeEight& eight = eights[m];
    const EightWide share = load_wide(eight.share);
    for (int k = 0; k < 3; ++k) {
      const EightWide even_way = Eight(h) * load_wide(eight.own[k + 3]);
      left[k] = left[k] + share * (even_way - load_wide(eight.moved[k]));
      left[k + 3] = left[k + 3] - share * load_wide(eight.moved[k + 3]);
    }
  }
  for (int k = 0; k < 3; ++k) {
    for (int word = 0; word < 2; ++word) speed[word][k] = primary[word][k + 3];
  }
  store_wide(sums_of_lanes(left), change);
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

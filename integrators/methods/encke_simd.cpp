#include "integrators/methods/encke_simd.hpp"

#include <hwy/highway.h>

#include <cmath>

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, 8>;
using Vector = hn::Vec<Tag>;
constexpr std::ptrdiff_t stages = 8, lanes = hn::MaxLanes(Tag());

/// Some stages side by side.
struct Row {
  Vector v;

  HWY_INLINE Row() : v(hn::Zero(Tag())) {}
  HWY_INLINE Row(Vector of) : v(of) {}                      // NOLINT: formulae read as on paper
  HWY_INLINE Row(double same) : v(hn::Set(Tag(), same)) {}  // NOLINT
  HWY_INLINE static Row load(const double* from) { return hn::LoadU(Tag(), from); }
  HWY_INLINE void store(double* to) const { hn::StoreU(v, Tag(), to); }
};
HWY_INLINE Row operator+(Row a, Row b) { return hn::Add(a.v, b.v); }
HWY_INLINE Row operator-(Row a, Row b) { return hn::Sub(a.v, b.v); }
HWY_INLINE Row operator*(Row a, Row b) { return hn::Mul(a.v, b.v); }
HWY_INLINE Row operator/(Row a, Row b) { return hn::Div(a.v, b.v); }
HWY_INLINE Row operator-(Row a) { return hn::Neg(a.v); }
HWY_INLINE Row root(Row a) { return hn::Sqrt(a.v); }
HWY_INLINE Row larger(Row a, Row b) { return hn::Max(a.v, b.v); }

HWY_INLINE Row dot(const double* a, const Row* b) { return Row(a[0]) * b[0] + Row(a[1]) * b[1] + Row(a[2]) * b[2]; }
HWY_INLINE Row norm2(const Row* a) { return a[0] * a[0] + a[1] * a[1] + a[2] * a[2]; }
HWY_INLINE void load(const double (*rows)[stages], std::ptrdiff_t i, Row* out) {
  for (int k = 0; k < 3; ++k) out[k] = Row::load(rows[k] + i);
}

/// n! c_n(z) = sum of (-1)^k n! / (2 k + n)! z^k for |z| up to 1, as `StumpffSeries` has it: `low` is what rounding
/// takes from the first coefficients, which would be a drift.
struct Series {
  static constexpr int terms = 10;
  double high[terms] = {}, low[3] = {};

  constexpr explicit Series(int n) {
    long double term = 1;
    for (int k = 0; k < terms; ++k) {
      high[k] = static_cast<double>(term);
      if (k < 3) low[k] = static_cast<double>(term - static_cast<long double>(high[k]));
      const int j = 2 * k + n;
      term /= -static_cast<long double>(j + 1) * static_cast<long double>(j + 2);
    }
  }
};
constexpr Series fourth(4), fifth(5);

HWY_INLINE Row sum_of(const Series& series, Row z) {
  Row sum = series.high[Series::terms - 1];
  for (int k = Series::terms - 2; k >= 3; --k) sum = Row(series.high[k]) + z * sum;
  return Row(1) +
         z * (Row(series.high[1]) + (Row(series.low[1]) + z * (Row(series.high[2]) + (Row(series.low[2]) + z * sum))));
}

/// G_0 to G_5 at s, as `KeplerTangent` computes them, with one doubling: for |beta s^2| up to 4.
struct SixFunctions {
  Row g0, g1, g2, g3, g4, g5;

  HWY_INLINE SixFunctions(double beta, Row s) {
    const Row part = s * Row(0.5), square = part * part, z = Row(beta) * square;
    g4 = square * square * sum_of(fourth, z) * Row(1.0 / 24);
    g5 = part * square * square * sum_of(fifth, z) / Row(120);
    g2 = square * Row(0.5) - Row(beta) * g4;
    g3 = part * square / Row(6) - Row(beta) * g5;
    g1 = part - Row(beta) * g3;
    g0 = Row(1) - Row(beta) * g2;
    g5 = Row(2) * (g5 + part * g4 + g2 * g3);
    g4 = Row(2) * (part + g1) * g3;
    g3 = Row(2) * (g3 + g1 * g2);
    g2 = Row(2) * g1 * g1;
    g1 = Row(2) * g0 * g1;
    g0 = Row(1) - Row(beta) * g2;
  }
  /// The same functions at s + d, to the second order in d.
  HWY_INLINE void shift(double beta, Row d) {
    const Row half = Row(0.5) * d, before = g1;
    g5 = g5 + d * (g4 + half * g3);
    g4 = g4 + d * (g3 + half * g2);
    g3 = g3 + d * (g2 + half * g1);
    g2 = g2 + d * (g1 + half * g0);
    g1 = g1 + d * (g0 - half * (Row(beta) * before));
    g0 = g0 - d * (Row(beta) * (before + half * g0));
  }
};

/// The start of an arc: t(s) = r0 s + eta0 G2 + zeta0 G3.
struct Start {
  double mu, r0, eta0, zeta0, beta;
};

/// The step of s to the root of t(s) = tau, by reversion of order 5, from where `missing` is left.
HWY_INLINE Row correction(Row missing, Row r, Row eta, Row zeta, double beta) {
  const Row inverse = Row(1) / r, d = missing * inverse;
  const Row p = eta * d * inverse, q = zeta * d * d * inverse, u = Row(beta) * d * d, p2 = p * p;
  const Row first = p * (Row(-0.5) + (Row(10) * q - Row(15) * p2 + u) * Row(1.0 / 24));
  return d + d * (first + (p2 * Row(0.5) - q * Row(1.0 / 6)));
}

void put_tangent(EnckeBody& body, std::ptrdiff_t i, const Start& a, const SixFunctions& g, Row s, Row r, Row tau) {
  const Row half(0.5), r0(a.r0), mu(a.mu);
  const Row g2_beta = g.g4 - s * g.g3 * half, g3_beta = (Row(3) * g.g5 - s * g.g4) * half;
  const Row over_r = Row(1) / r;
  const Row s_r = -(g.g1 * over_r), s_eta = -(g.g2 * over_r);
  const Row s_beta = -((Row(a.eta0) * g2_beta + Row(a.zeta0) * g3_beta - r0 * g.g3) * over_r);
  const auto put = [&](int first, Row value, Row by_r, Row by_eta, Row by_beta) {
    value.store(body.upper[first] + i);
    const int at = first == 0 ? 2 : 5;
    (-(mu * (by_r - Row(2 * a.mu / (a.r0 * a.r0)) * by_beta) / r0)).store(body.upper[at] + i);
    (-(mu * by_eta)).store(body.upper[at + 1] + i);
    (Row(2 * a.mu) * by_beta).store(body.upper[at + 2] + i);
  };
  const Row part = g.g2 / r0;
  put(0, Row(1) - mu * part, (g.g1 * s_r - part) / r0, g.g1 * s_eta / r0, (g.g1 * s_beta + g2_beta) / r0);
  put(1, tau - mu * g.g3, g.g2 * s_r, g.g2 * s_eta, g.g2 * s_beta + g3_beta);
}

std::uint8_t orbits(EnckeBody& body, const double* tau) {
  const double *x = body.x0, *v = body.v0;
  Start a{};
  a.mu = body.mu;
  a.r0 = std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
  a.eta0 = x[0] * v[0] + x[1] * v[1] + x[2] * v[2];
  const double v2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  a.beta = 2 * a.mu / a.r0 - v2;
  a.zeta0 = a.r0 * v2 - a.mu;
  unsigned missed = 0;
  for (std::ptrdiff_t i = 0; i < stages; i += lanes) {
    const Row t = Row::load(tau + i), r0(a.r0), eta0(a.eta0), zeta0(a.zeta0);
    Row s = correction(t, r0, eta0, zeta0, a.beta);
    const SixFunctions near(a.beta, s);
    const Row near_r = r0 + (eta0 * near.g1 + zeta0 * near.g2);
    // The last step begins where the lower half of the digits is cut off, so that it is many roundings long and of
    // either sign: a fraction of one would be rounded off, always to the same side.
    const Row next = s + correction((t - r0 * s) - (eta0 * near.g2 + zeta0 * near.g3), near_r,
                                    eta0 * near.g0 + zeta0 * near.g1, Row(a.mu) - Row(a.beta) * near_r, a.beta);
    const Row wide = Row(0x1p27 + 1) * next;
    s = wide - (wide - next);
    SixFunctions g(a.beta, s);
    const Row missing = (t - r0 * s) - (eta0 * g.g2 + zeta0 * g.g3),
              over = Row(1) / (r0 + (eta0 * g.g1 + zeta0 * g.g2));
    const Row first = missing * over, d = first - Row(0.5) * (eta0 * g.g0 + zeta0 * g.g1) * over * first * first;
    g.shift(a.beta, d);
    s = s + d;
    const Row r = r0 + (eta0 * g.g1 + zeta0 * g.g2);
    put_tangent(body, i, a, g, s, r, t);
    const Row along_x = -(Row(a.mu) * g.g2 / r0), along_v = t - Row(a.mu) * g.g3;
    Row place[3];
    for (int k = 0; k < 3; ++k) {
      place[k] = Row(x[k]) + (along_x * Row(x[k]) + along_v * Row(v[k]));
      place[k].store(body.orbit[k] + i);
    }
    const Row r2 = norm2(place);
    (Row(1) / r2).store(body.inverse_r2 + i);
    (Row(a.mu) / (r2 * root(r2))).store(body.mu_r3 + i);
    // What a shift leaves is of the order d^3, and beyond |beta s^2| = 4 the series is not good.
    const Row few = hn::Abs((Row(a.beta) * s * s).v), rest = hn::Abs(d.v);
    const auto found = hn::And(hn::Le(few.v, Row(4).v), hn::Le(rest.v, (Row(0x1p-23) * Row(hn::Abs(s.v))).v));
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(Tag(), hn::Not(found), bits);
    missed |= (bits[0] & ((1U << lanes) - 1)) << i;
  }
  return static_cast<std::uint8_t>(missed);
}

/// sum_j a_ji of the rates of one coordinate.
HWY_INLINE Row sum_over_stages(const double* a, std::ptrdiff_t i, const double* rates) {
  Row even = Row::load(a + i) * Row(rates[0]), odd = Row::load(a + stages + i) * Row(rates[1]);
  for (std::ptrdiff_t j = 2; j < stages; j += 2) {
    even = even + Row::load(a + stages * j + i) * Row(rates[j]);
    odd = odd + Row::load(a + stages * (j + 1) + i) * Row(rates[j + 1]);
  }
  return even + odd;
}

void depart(EnckeBody* bodies, std::ptrdiff_t n, const double* a, double h) {
  for (std::ptrdiff_t m = 0; m < n; ++m) {
    EnckeBody& body = bodies[m];
    for (std::ptrdiff_t i = 0; i < stages; i += lanes) {
      Row x[3], v[3], place[3];
      for (int k = 0; k < 3; ++k) {
        x[k] = sum_over_stages(a, i, body.rate_x[k]);
        v[k] = sum_over_stages(a, i, body.rate_v[k]);
      }
      const auto upper = [&](int k) { return Row::load(body.upper[k] + i); };
      const Row xx = dot(body.x0, x), mixed = dot(body.v0, x) + dot(body.x0, v), vv = dot(body.v0, v);
      const Row of_f = upper(2) * xx + upper(3) * mixed + upper(4) * vv;
      const Row of_g = upper(5) * xx + upper(6) * mixed + upper(7) * vv;
      for (int k = 0; k < 3; ++k) {
        const Row d =
            Row(h) * ((upper(0) * x[k] + upper(1) * v[k]) + (of_f * Row(body.x0[k]) + of_g * Row(body.v0[k])));
        d.store(body.away[k] + i);
        place[k] = Row::load(body.orbit[k] + i) + d;
        place[k].store(body.place[k] + i);
      }
      const Row r2 = norm2(place), pull = Row(body.gm) / (r2 * root(r2));
      for (int k = 0; k < 3; ++k) (pull * place[k]).store(body.pull[k] + i);
    }
  }
}

/// What the attraction by the heaviest body has beyond the tangent of the orbit: (1 + e)^(-3/2) - 1 with
/// e = |k + d|^2 / |k|^2 - 1, without cancellation.
HWY_INLINE void begin_perturbation(EnckeBody& body, std::ptrdiff_t i) {
  Row orbit[3], away[3];
  load(body.orbit, i, orbit);
  load(body.away, i, away);
  const Row inverse = Row::load(body.inverse_r2 + i), pull = Row::load(body.mu_r3 + i);
  const Row along = (orbit[0] * away[0] + orbit[1] * away[1] + orbit[2] * away[2]) * inverse;
  const Row e = Row(2) * along + norm2(away) * inverse, up = Row(1) + e, whole = up * root(up);
  const Row fall = -(e * (Row(3) + e * (Row(3) + e)) / (whole * (Row(1) + whole))), beyond = fall + Row(3) * along;
  for (int k = 0; k < 3; ++k) (-(pull * (beyond * orbit[k] + fall * away[k]))).store(body.fresh[k] + i);
}

double attract(EnckeBody* bodies, std::ptrdiff_t n) {
  double strongest[stages] = {};
  for (std::ptrdiff_t i = 0; i < stages; i += lanes) {
    Row most;
    for (std::ptrdiff_t m = 0; m < n; ++m) begin_perturbation(bodies[m], i);
    for (std::ptrdiff_t m = 1; m < n; ++m) {
      EnckeBody& one = bodies[m];
      Row place[3], fresh[3], pull[3];
      load(one.place, i, place);
      load(one.fresh, i, fresh);
      load(one.pull, i, pull);
      for (std::ptrdiff_t o = 0; o < m; ++o) {
        EnckeBody& other = bodies[o];
        if (one.gm == 0 && other.gm == 0) continue;
        Row d[3];
        for (int k = 0; k < 3; ++k) d[k] = Row::load(other.place[k] + i) - place[k];
        const Row r2 = norm2(d), inverse = Row(1) / (r2 * root(r2));
        const Row by_other = Row(other.gm) * inverse, by_one = Row(one.gm) * inverse;
        most = larger(most, by_other + by_one);
        for (int k = 0; k < 3; ++k) {
          fresh[k] = fresh[k] + (by_other * d[k] - Row::load(other.pull[k] + i));
          (Row::load(other.fresh[k] + i) - (by_one * d[k] + pull[k])).store(other.fresh[k] + i);
        }
      }
      for (int k = 0; k < 3; ++k) fresh[k].store(one.fresh[k] + i);
    }
    most.store(strongest + i);
  }
  double worst = 0;
  for (const double one : strongest) worst = one > worst ? one : worst;
  return worst;
}

void predict(EnckeBody* bodies, std::ptrdiff_t n, const double* w) {
  for (std::ptrdiff_t m = 0; m < n; ++m) {
    for (int k = 0; k < 3; ++k) {
      for (std::ptrdiff_t i = 0; i < stages; i += lanes)
        sum_over_stages(w, i, bodies[m].perturbation[k]).store(bodies[m].fresh[k] + i);
    }
  }
}

void take(EnckeBody* bodies, std::ptrdiff_t n) {
  for (std::ptrdiff_t m = 0; m < n; ++m) {
    EnckeBody& body = bodies[m];
    for (std::ptrdiff_t i = 0; i < stages; i += lanes) {
      Row p[3], old[3], change[3];
      load(body.fresh, i, p);
      load(body.perturbation, i, old);
      for (int k = 0; k < 3; ++k) {
        change[k] = p[k] - old[k];
        p[k].store(body.perturbation[k] + i);
      }
      norm2(change).store(body.change2 + i);
      larger(norm2(p), norm2(old)).store(body.size2 + i);
      const auto upper = [&](int k) { return Row::load(body.upper[k] + i); };
      const Row ax = dot(body.x0, p), av = dot(body.v0, p);
      const Row along_x = upper(2) * ax + upper(5) * av, across = upper(3) * ax + upper(6) * av,
                along_v = upper(4) * ax + upper(7) * av;
      for (int k = 0; k < 3; ++k) {
        (-(upper(1) * p[k] + (across * Row(body.x0[k]) + along_v * Row(body.v0[k])))).store(body.rate_x[k] + i);
        (upper(0) * p[k] + (along_x * Row(body.x0[k]) + across * Row(body.v0[k]))).store(body.rate_v[k] + i);
      }
    }
  }
}

}  // namespace

extern const EnckeKernels encke_kernels;
const EnckeKernels encke_kernels{orbits, depart, attract, predict, take};

}  // namespace noether::NOETHER_SIMD_LEVEL

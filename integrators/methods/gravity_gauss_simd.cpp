#include "integrators/methods/gravity_gauss_simd.hpp"

#include "numbers/compensated_sum_simd.hpp"
#include "numbers/reciprocal_sqrt_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

using Lanes = hn::CappedTag<double, 8>;
using Vector = hn::Vec<Lanes>;
constexpr std::ptrdiff_t stages = 8, lanes = hn::MaxLanes(Lanes());

/// Accelerations, displacements or separations, eight of each: x, y and z.
struct Axes {
  const double *x, *y, *z;
  Axes(const double* all, std::ptrdiff_t stride) : x(all), y(all + stride), z(all + 2 * stride) {}
};

/// What rounding takes from a product.
HWY_INLINE Vector rounded_off(Vector a, Vector b, Vector product) {
#if HWY_NATIVE_FMA
  return hn::MulSub(a, b, product);
#else
  const auto upper = [](Vector x) {  // its first 26 bits
    const Vector far = hn::Mul(hn::Set(Lanes(), 134217729.0), x);
    return hn::Sub(far, hn::Sub(far, x));
  };
  const Vector a1 = upper(a), b1 = upper(b), a2 = hn::Sub(a, a1), b2 = hn::Sub(b, b1);
  const Vector crossed = hn::Add(hn::Add(hn::Sub(hn::Mul(a1, b1), product), hn::Mul(a1, b2)), hn::Mul(a2, b1));
  return hn::Add(crossed, hn::Mul(a2, b2));
#endif
}

void scale_table(double h2, double h2_low, const double* a, const double* a_low, double* out, double* out_low) {
  const Lanes d;
  const Vector high = hn::Set(d, h2), low = hn::Set(d, h2_low);
  for (std::ptrdiff_t k = 0; k < stages * stages; k += lanes) {
    const Vector entry = hn::LoadU(d, a + k), product = hn::Mul(high, entry);
    hn::StoreU(product, d, out + k);
    const Vector lost = hn::MulAdd(high, hn::LoadU(d, a_low + k), hn::Mul(low, entry));
    hn::StoreU(hn::Add(rounded_off(high, entry, product), lost), d, out_low + k);
  }
}

void begin(const StepBeginning& beginning) {
  const Lanes d;
  const StepBeginning b = beginning;
  const std::ptrdiff_t n = 3 * b.bodies;
  for (int half = 0; half < 2; ++half) {
    const double big = 1.5 * b.grids[half];  // its sums are multiples of 2^-52 of the grid
    for (std::ptrdiff_t k = half * n; k < (half + 1) * n; ++k) b.on_grid[k] = (b.y[k] + big) - big;
  }
  for (std::ptrdiff_t i = 0; i < stages; i += lanes) {
    const Vector c_h = hn::LoadU(d, b.c_h + i), c_h_low = hn::LoadU(d, b.c_h_low + i);
    for (std::ptrdiff_t k = 0; k < n; ++k) {
      const Vector x = hn::Set(d, (b.y[k] - b.on_grid[k]) + b.low[k]), most = hn::Set(d, b.on_grid[n + k]);
      const Vector v = hn::Set(d, (b.y[n + k] - b.on_grid[n + k]) + b.low[n + k]);
      hn::Store(hn::MulAdd(c_h, v, hn::MulAdd(c_h_low, most, x)), d, b.known + stages * k + i);
    }
  }
}

/// From body i to body j: (X_j - X_i) + c h (V_j - V_i), rounded once.
HWY_INLINE void separate(const StepBeginning& b, std::ptrdiff_t i, std::ptrdiff_t j, double* out) {
  const Lanes d;
  const double* const v = b.on_grid + 3 * b.bodies;
  const Vector dx = hn::Set(d, b.on_grid[j] - b.on_grid[i]), dv = hn::Set(d, v[j] - v[i]);
  for (std::ptrdiff_t k = 0; k < stages; k += lanes) {
    hn::Store(hn::MulAdd(hn::LoadU(d, b.c_h + k), dv, dx), d, out + k);
  }
}

void separations(const AttractingBodies& bodies, const StepBeginning& beginning, double* out) {
  const AttractingBodies b = bodies;
  const StepBeginning at = beginning;
  for (std::ptrdiff_t axis = 0; axis < 3 * at.bodies; axis += at.bodies) {
    for (std::ptrdiff_t k = 0; k < b.massive_count; ++k) {
      for (std::ptrdiff_t l = k + 1; l < b.massive_count; ++l, out += stages)
        separate(at, axis + b.massive[k], axis + b.massive[l], out);
    }
    for (std::ptrdiff_t k = 0; k < b.tracer_count; ++k) {
      for (std::ptrdiff_t l = 0; l < b.massive_count; ++l, out += stages)
        separate(at, axis + b.tracers[k], axis + b.massive[l], out);
    }
  }
}

#if HWY_TARGET == HWY_AVX2 || HWY_TARGET <= HWY_AVX3

/// (w + w w_low) / r^3, with the same bits on every processor: `reciprocal_cube` from the seed by integers, with the
/// weight in it from the beginning. The seed has 17 bits, so that its square and its cube are exact.
HWY_INLINE Vector weighted_cube(Vector r2, double weight, double weight_low) {
  const Lanes d;
  const hn::RebindToUnsigned<Lanes> bits;
  const Vector x[1] = {r2};
  Vector y[1];
  integer_seed(d, x, y);
  y[0] = hn::BitCast(d, hn::And(hn::BitCast(bits, y[0]), hn::Set(bits, ~((std::uint64_t{1} << 36U) - 1))));
  const Vector square = hn::Mul(y[0], y[0]), e = hn::NegMulAdd(r2, square, hn::Set(d, 1.0));
  const Vector cube = hn::Mul(hn::Mul(square, y[0]), hn::Set(d, weight));
  const Vector series =
      hn::MulAdd(hn::MulAdd(hn::Set(d, 2.1875), e, hn::Set(d, 1.875)), e, hn::Set(d, 1.5));  // (1 - e)^(-3/2)
  return hn::MulAdd(cube, hn::MulAdd(e, series, hn::Set(d, weight_low)), cube);
}

#else

HWY_INLINE Vector weighted_cube(Vector r2, double weight, double weight_low) {
  const Lanes d;
  const Vector cube = hn::Div(hn::Set(d, weight), hn::Mul(r2, hn::Sqrt(r2)));
  return hn::MulAdd(cube, hn::Set(d, weight_low), cube);
}

#endif

/// One body in the lanes of a register: where it is, and what it feels.
struct Body {
  Vector x, y, z, ax, ay, az;
};

/// The vector by which a pair attracts each other; products are rounded before they are added, so that pulls of bodies
/// that mirror each other cancel to the last bit.
struct Pull {
  Vector x, y, z;

  HWY_INLINE Pull(const Body& body, const Axes& d, std::ptrdiff_t at, const Axes& apart, std::ptrdiff_t pair,
                  std::ptrdiff_t lane, const AttractingBodies& b, Vector& least) {
    const Lanes tag;
    const std::ptrdiff_t by = stages * pair + lane;
    const Vector dx = hn::Add(hn::Sub(hn::Load(tag, d.x + at), body.x), hn::Load(tag, apart.x + by));
    const Vector dy = hn::Add(hn::Sub(hn::Load(tag, d.y + at), body.y), hn::Load(tag, apart.y + by));
    const Vector dz = hn::Add(hn::Sub(hn::Load(tag, d.z + at), body.z), hn::Load(tag, apart.z + by));
    const Vector r2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    least = hn::Min(least, r2);
    const Vector c = weighted_cube(r2, b.weight[pair], b.weight_low[pair]);
    x = hn::Mul(c, dx);
    y = hn::Mul(c, dy);
    z = hn::Mul(c, dz);
  }
};

/// Massive body k and all behind it. The first finds no sums of others.
template <bool first>
HWY_INLINE void attract_row(const AttractingBodies& b, std::ptrdiff_t k, std::ptrdiff_t& pair, std::ptrdiff_t lane,
                            const Axes& d, const Axes& apart, double* a, std::ptrdiff_t n, Vector& least) {
  const Lanes tag;
  double *const ax = a, *const ay = a + stages * n, *const az = a + 2 * stages * n;
  const std::ptrdiff_t own = stages * b.massive[k] + lane;
  const auto felt = [&](const double* of, std::ptrdiff_t at)
                        HWY_ATTR { return first ? hn::Zero(tag) : hn::Load(tag, of + at); };
  Body body{hn::Load(tag, d.x + own),
            hn::Load(tag, d.y + own),
            hn::Load(tag, d.z + own),
            felt(ax, own),
            felt(ay, own),
            felt(az, own)};
  for (std::ptrdiff_t l = k + 1; l < b.massive_count; ++l, ++pair) {
    const std::ptrdiff_t at = stages * b.massive[l] + lane;
    const Pull pull(body, d, at, apart, pair, lane, b, least);
    body.ax = hn::Add(body.ax, pull.x);
    body.ay = hn::Add(body.ay, pull.y);
    body.az = hn::Add(body.az, pull.z);
    hn::Store(hn::Sub(felt(ax, at), pull.x), tag, ax + at);
    hn::Store(hn::Sub(felt(ay, at), pull.y), tag, ay + at);
    hn::Store(hn::Sub(felt(az, at), pull.z), tag, az + at);
  }
  const Vector w = hn::Set(tag, b.inverse[k]), w_low = hn::Set(tag, b.inverse_low[k]);
  hn::Store(hn::MulAdd(body.ax, w, hn::Mul(body.ax, w_low)), tag, ax + own);
  hn::Store(hn::MulAdd(body.ay, w, hn::Mul(body.ay, w_low)), tag, ay + own);
  hn::Store(hn::MulAdd(body.az, w, hn::Mul(body.az, w_low)), tag, az + own);
}

double attract(const AttractingBodies& bodies, std::ptrdiff_t n, const double* displacements,
               const double* separations_of_pairs, std::ptrdiff_t pairs, double* a) {
  const Lanes tag;
  const AttractingBodies b = bodies;
  const Axes d(displacements, stages * n), apart(separations_of_pairs, stages * pairs);
  Vector least = hn::Set(tag, 1e300);
  for (std::ptrdiff_t lane = 0; lane < stages; lane += lanes) {
    std::ptrdiff_t pair = 0;
    attract_row<true>(b, 0, pair, lane, d, apart, a, n, least);
    for (std::ptrdiff_t k = 1; k < b.massive_count; ++k) attract_row<false>(b, k, pair, lane, d, apart, a, n, least);
    for (std::ptrdiff_t k = 0; k < b.tracer_count; ++k) {
      const std::ptrdiff_t own = stages * b.tracers[k] + lane;
      Body body{hn::Load(tag, d.x + own),
                hn::Load(tag, d.y + own),
                hn::Load(tag, d.z + own),
                hn::Zero(tag),
                hn::Zero(tag),
                hn::Zero(tag)};
      for (std::ptrdiff_t l = 0; l < b.massive_count; ++l, ++pair) {
        const Pull pull(body, d, stages * b.massive[l] + lane, apart, pair, lane, b, least);
        body.ax = hn::Add(body.ax, pull.x);
        body.ay = hn::Add(body.ay, pull.y);
        body.az = hn::Add(body.az, pull.z);
      }
      hn::Store(body.ax, tag, a + own);
      hn::Store(body.ay, tag, a + stages * n + own);
      hn::Store(body.az, tag, a + 2 * stages * n + own);
    }
  }
  return hn::GetLane(hn::MinOfLanes(tag, least));
}

/// What `lanes` stages take from each stage: the coefficients stay in registers while the variables pass.
class Rows {
 public:
  explicit HWY_INLINE Rows(const double* a) {
    for (int j = 0; j < stages; ++j) row_[j] = hn::LoadU(Lanes(), a + stages * j);
  }
  /// first + sum_j a_ji F_j of one variable: two chains, since each addition waits for the one before.
  HWY_INLINE Vector sum(Vector first, const double* rates) const {
    const Lanes d;
    Vector even = hn::MulAdd(row_[0], hn::Set(d, rates[0]), first), odd = hn::Mul(row_[1], hn::Set(d, rates[1]));
    for (int j = 2; j < stages; j += 2) {
      even = hn::MulAdd(row_[j], hn::Set(d, rates[j]), even);
      odd = hn::MulAdd(row_[j + 1], hn::Set(d, rates[j + 1]), odd);
    }
    return hn::Add(even, odd);
  }

 private:
  Vector row_[stages];
};

void displacements(std::ptrdiff_t n, const double* rates, const double* a, const double* known, double* out) {
  const Lanes d;
  for (std::ptrdiff_t i = 0; i < stages; i += lanes) {
    const Rows rows(a + i);
    for (std::ptrdiff_t m = 0; m < n; ++m) {
      const std::ptrdiff_t at = stages * m + i;
      hn::Store(rows.sum(hn::Load(d, known + at), rates + stages * m), d, out + at);
    }
  }
}

void first_displacements(std::ptrdiff_t n, const double* rates, const double* rates_before, const double* w,
                         double scale, const double* known, double* out) {
  const Lanes d;
  const Vector factor = hn::Set(d, scale);
  for (std::ptrdiff_t i = 0; i < stages; i += lanes) {
    const Rows rows(w + i);
    for (std::ptrdiff_t m = 0; m < n; ++m)
      hn::Store(rows.sum(hn::Zero(d), rates + stages * m), d, out + stages * m + i);
    if (rates_before != nullptr) {
      const Rows before(w + stages * stages + i);
      for (std::ptrdiff_t m = 0; m < n; ++m) {
        double* const at = out + stages * m + i;
        hn::Store(before.sum(hn::Load(d, at), rates_before + stages * m), d, at);
      }
    }
    for (std::ptrdiff_t m = 0; m < n; ++m) {
      const std::ptrdiff_t at = stages * m + i;
      hn::Store(hn::MulAdd(factor, hn::Load(d, out + at), hn::Load(d, known + at)), d, out + at);
    }
  }
}

bool moved(std::ptrdiff_t n, const double* now, const double* before, double tolerance) {
  const Lanes d;
  const Vector minus = hn::Set(d, -tolerance * tolerance);
  auto still = hn::Eq(hn::Zero(d), hn::Zero(d));
  for (std::ptrdiff_t at = 0; at < stages * n; at += lanes) {
    Vector size = hn::Zero(d), change = hn::Zero(d);
    for (std::ptrdiff_t axis = 0; axis < 3; ++axis) {
      const Vector x = hn::Load(d, now + axis * stages * n + at);
      const Vector dx = hn::Sub(x, hn::Load(d, before + axis * stages * n + at));
      size = hn::MulAdd(x, x, size);
      change = hn::MulAdd(dx, dx, change);
    }
    still = hn::And(still, hn::Le(hn::MulAdd(minus, size, change), hn::Zero(d)));  // never of what is no number
  }
  return !hn::AllTrue(d, still);
}

/// `lanes` variables by eight stages become the rates of each stage, a variable in each lane.
HWY_INLINE void transpose(const double* rates, Vector (&stage)[stages]) {
  const Lanes d;
#if HWY_TARGET == HWY_SCALAR
  for (int j = 0; j < stages; ++j) stage[j] = hn::Set(d, rates[j]);
#else
  if constexpr (lanes == 4) {
    for (int half = 0; half < 8; half += 4) {
      Vector row[4];
      for (int k = 0; k < 4; ++k) row[k] = hn::Load(d, rates + stages * k + half);
      const Vector a0 = hn::InterleaveLower(d, row[0], row[1]), a1 = hn::InterleaveUpper(d, row[0], row[1]);
      const Vector b0 = hn::InterleaveLower(d, row[2], row[3]), b1 = hn::InterleaveUpper(d, row[2], row[3]);
      stage[half] = hn::ConcatLowerLower(d, b0, a0);
      stage[half + 1] = hn::ConcatLowerLower(d, b1, a1);
      stage[half + 2] = hn::ConcatUpperUpper(d, b0, a0);
      stage[half + 3] = hn::ConcatUpperUpper(d, b1, a1);
    }
  } else if constexpr (lanes == 8) {
    // Pairs of variables, then blocks of two numbers: block q of pair p becomes block p of stage 2 q or 2 q + 1.
    for (int odd = 0; odd < 2; ++odd) {
      Vector pair[4];
      for (int p = 0; p < 4; ++p) {
        const Vector one = hn::Load(d, rates + stages * 2 * p), two = hn::Load(d, rates + stages * (2 * p + 1));
        pair[p] = odd == 0 ? hn::InterleaveLower(d, one, two) : hn::InterleaveUpper(d, one, two);
      }
      const auto even_blocks = [&](Vector a, Vector b)
                                   HWY_ATTR { return hn::OddEvenBlocks(hn::SwapAdjacentBlocks(b), a); };
      const auto odd_blocks = [&](Vector a, Vector b)
                                  HWY_ATTR { return hn::OddEvenBlocks(b, hn::SwapAdjacentBlocks(a)); };
      const Vector t0 = even_blocks(pair[0], pair[1]), t1 = odd_blocks(pair[0], pair[1]);
      const Vector u0 = even_blocks(pair[2], pair[3]), u1 = odd_blocks(pair[2], pair[3]);
      stage[odd] = hn::ConcatLowerLower(d, u0, t0);
      stage[2 + odd] = hn::ConcatLowerLower(d, u1, t1);
      stage[4 + odd] = hn::ConcatUpperUpper(d, u0, t0);
      stage[6 + odd] = hn::ConcatUpperUpper(d, u1, t1);
    }
  } else {  // two lanes
    for (int j = 0; j < stages; j += 2) {
      const Vector one = hn::Load(d, rates + j), two = hn::Load(d, rates + stages + j);
      stage[j] = hn::InterleaveLower(d, one, two);
      stage[j + 1] = hn::InterleaveUpper(d, one, two);
    }
  }
#endif
}

/// first + w_0 a + w_1 b + w_2 c + w_3 d, in two chains.
HWY_INLINE Vector four(Vector first, const double* w, Vector a, Vector b, Vector c, Vector d) {
  const Lanes tag;
  return hn::Add(hn::MulAdd(hn::Set(tag, w[0]), a, hn::MulAdd(hn::Set(tag, w[1]), b, first)),
                 hn::MulAdd(hn::Set(tag, w[2]), c, hn::Mul(hn::Set(tag, w[3]), d)));
}

/// The same with weights in two words. A sum that is rounded already is hardly ever changed by what low words add, half
/// a last bit at most, and what they stand for would be lost at every step; so their part comes first.
HWY_INLINE Vector four(const double* w, const double* low, Vector a, Vector b, Vector c, Vector d) {
  return four(four(hn::Zero(Lanes()), low, a, b, c, d), w, a, b, c, d);
}

/// sum_j w_j F_j
HWY_INLINE Vector eight(const double* w, const Vector (&f)[stages]) {
  const Vector none = hn::Zero(Lanes());
  return hn::Add(four(none, w, f[0], f[1], f[2], f[3]), four(none, w + 4, f[4], f[5], f[6], f[7]));
}
HWY_INLINE Vector eight(const double* w, const double* low, const Vector (&f)[stages]) {
  return hn::Add(four(w, low, f[0], f[1], f[2], f[3]), four(w + 4, low + 4, f[4], f[5], f[6], f[7]));
}

/// Weights sum to 1, so that one stage in the middle with the weight 1, whose products with the step are known exactly,
/// and differences from it leave nothing to rounding but a part of these. Where they are symmetric about the middle of
/// the step, sums and differences of mirrored stages need half the products.
///
/// Nothing here may be wrong by the same part at each step: a drift of the energy by 1e-19 a step is above the random
/// walk after 1e5 of them. So weights have low words, and the square of the step, which has none, is the step twice.
template <bool mirrored> void finish_stages(const StepEnd& end) {
  const Lanes tag;
  const StepEnd s = end;
  const Vector h = hn::Set(tag, s.h), half = hn::Set(tag, 0.5);
  const Vector half_h2 = hn::Set(tag, s.half_h2), half_h2_low = hn::Set(tag, s.half_h2_low);
  for (std::ptrdiff_t m = 0; m < s.n; m += lanes) {
    const std::ptrdiff_t count = s.n - m;
    Vector f[stages];
    transpose(s.rates + stages * m, f);
    const Vector middle = f[mirrored ? 3 : s.middle];
    for (int j = 0; j < stages; ++j) {
      if (!mirrored || j != 3) f[j] = hn::Sub(f[j], middle);
    }
    Vector even, odd;
    if constexpr (mirrored) {
      even = four(s.b, s.b_low, hn::Add(f[0], f[7]), hn::Add(f[1], f[6]), hn::Add(f[2], f[5]), f[4]);
      odd = four(s.odd, s.odd_low, hn::Sub(f[0], f[7]), hn::Sub(f[1], f[6]), hn::Sub(f[2], f[5]), hn::Neg(f[4]));
    } else {
      even = eight(s.b, s.b_low, f);
      odd = eight(s.odd, s.odd_low, f);
    }
    const Vector v = load_first(tag, s.v + m, count), hv = hn::Mul(h, v), bend = hn::Mul(half_h2, middle);
    const Vector lower = hn::MulAdd(h, load_first(tag, s.v_low + m, count), rounded_off(h, v, hv));
    const Vector lost = hn::Add(hn::MulAdd(half_h2_low, middle, rounded_off(half_h2, middle, bend)), lower);
    const Vector small = hn::MulAdd(h, hn::Mul(h, hn::MulAdd(half, even, odd)), lost);
    add_with_errors(tag, s.x + m, s.x_low + m, count, hv, bend, small);
    const Vector kick = hn::Mul(h, middle);
    add_with_error(tag, s.v + m, s.v_low + m, count, kick, hn::MulAdd(h, even, rounded_off(h, middle, kick)));
  }
}

void finish(const StepEnd& end) { end.mirrored ? finish_stages<true>(end) : finish_stages<false>(end); }

void derivatives(std::ptrdiff_t n, const double* rates, const double* weights, bool mirrored, double* out,
                 std::ptrdiff_t stride) {
  const Lanes tag;
  for (std::ptrdiff_t m = 0; m < n; m += lanes) {
    Vector f[stages], sum[4], difference[4];
    transpose(rates + stages * m, f);
    for (int j = 0; j < 4; ++j) {
      sum[j] = hn::Add(f[j], f[7 - j]);
      difference[j] = hn::Sub(f[j], f[7 - j]);
    }
    for (int q = 0; q < 3; ++q) {
      // About the middle of mirrored stages, weights of the first derivative are odd, the others even.
      const Vector(&half)[4] = q == 1 ? difference : sum;
      const double* const w = weights + stages * q;
      const Vector middle = mirrored ? four(hn::Zero(tag), w, half[0], half[1], half[2], half[3]) : eight(w, f);
      hn::StoreU(middle, tag, out + q * stride + m);
      hn::StoreU(eight(w + 3 * stages, f), tag, out + (3 + q) * stride + m);
    }
  }
}

}  // namespace

extern const GravityGaussKernels gravity_gauss_kernels;
const GravityGaussKernels gravity_gauss_kernels{scale_table,         begin, separations, attract,    displacements,
                                                first_displacements, moved, finish,      derivatives};

}  // namespace noether::NOETHER_SIMD_LEVEL

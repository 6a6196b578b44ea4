#include "integrators/methods/collocation_simd.hpp"

#include "numbers/compensated_sum_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, 8>;
using Vector = hn::Vec<Lanes>;
using BitLanes = hn::RebindToSigned<Lanes>;
using Bits = hn::Vec<BitLanes>;
constexpr int stages = 8;
constexpr std::ptrdiff_t lanes = hn::MaxLanes(Lanes());

/// What the lanes of `D` take from each of `terms` stages: the coefficients stay in registers while the variables pass.
template <int terms, class D> class Rows {
 public:
  explicit HWY_INLINE Rows(const double* a) {
    for (int j = 0; j < terms; ++j) row_[j] = hn::LoadU(D(), a + stages * j);
  }
  /// sum_j a_ji F_j of one variable.
  HWY_INLINE hn::Vec<D> sum(const double* rates) const {
    const D d;
    auto even = hn::Mul(row_[0], hn::Set(d, rates[0])), odd = hn::Mul(row_[1], hn::Set(d, rates[1]));
    for (int j = 2; j < terms; j += 2) {  // two chains: each addition waits for the one before
      even = hn::MulAdd(row_[j], hn::Set(d, rates[j]), even);
      odd = hn::MulAdd(row_[j + 1], hn::Set(d, rates[j + 1]), odd);
    }
    return hn::Add(even, odd);
  }

 private:
  hn::Vec<D> row_[terms];
};

template <int terms> void values_of(const StageSums& s, const double* a, double* out) {
  const Lanes d;
  const Vector h = hn::Set(d, s.h);
  for (std::ptrdiff_t i = 0; i < stages; i += lanes) {
    const Rows<terms, Lanes> rows(a + i);
    for (std::ptrdiff_t m = 0; m < s.n; ++m) {
      const Vector small = hn::MulAdd(h, rows.sum(s.rates + stages * m), hn::Set(d, s.low[m]));
      hn::StoreU(hn::Add(hn::Set(d, s.y[m]), small), d, out + stages * m + i);
    }
  }
}
void values(const StageSums& sums, const double* a, double* out) {
  const StageSums s = sums;
  s.terms <= 4 ? values_of<4>(s, a, out) : values_of<8>(s, a, out);
}

template <int terms>
void positions_of(const StageSums& s, const double* a, const double* c, const double* c_low, const double* v,
                  double* out) {
  const Lanes d;
  const Vector h2 = hn::Set(d, s.h2), h2_low = hn::Set(d, s.h2_low);
  for (std::ptrdiff_t i = 0; i < stages; i += lanes) {
    const Rows<terms, Lanes> rows(a + i);
    const Vector node = hn::LoadU(d, c + i), node_low = hn::LoadU(d, c_low + i);
    for (std::ptrdiff_t m = 0; m < s.n; ++m) {
      const Vector hv = hn::Set(d, s.h * v[m]);
      const Vector sum = rows.sum(s.rates + stages * m);
      const Vector bend = hn::MulAdd(h2, sum, hn::MulAdd(h2_low, sum, hn::Set(d, s.low[m])));
      const Vector small = hn::MulAdd(node_low, hv, bend);
      hn::StoreU(hn::Add(hn::Set(d, s.y[m]), hn::MulAdd(node, hv, small)), d, out + stages * m + i);
    }
  }
}
void positions(const StageSums& sums, const double* a, const double* c, const double* c_low, const double* v,
               double* out) {
  const StageSums s = sums;
  s.terms <= 4 ? positions_of<4>(s, a, c, c_low, v, out) : positions_of<8>(s, a, c, c_low, v, out);
}

void extrapolation(const double* c, const double* barycentric, double ratio, double* w) {
  const Lanes d;
  const Vector one = hn::Set(d, 1.0);
  for (std::ptrdiff_t i = 0; i < stages; i += lanes) {
    const Vector x = hn::MulAdd(hn::LoadU(d, c + i), hn::Set(d, ratio), one);
    // Weight j is the product of x - c_m over all other m: those before j, and, on the way back, those behind it.
    Vector before[stages], product = one;
    for (int j = 0; j < stages; ++j) {
      before[j] = hn::Mul(hn::Set(d, barycentric[j]), product);
      product = hn::Mul(product, hn::Sub(x, hn::Set(d, c[j])));
    }
    product = one;
    for (int j = stages - 1; j >= 0; --j) {
      hn::StoreU(hn::Mul(before[j], product), d, w + stages * j + i);
      product = hn::Mul(product, hn::Sub(x, hn::Set(d, c[j])));
    }
  }
}

void combine(const StageSums& sums, const double* w, double* out) {
  const Lanes d;
  const StageSums s = sums;
  for (std::ptrdiff_t i = 0; i < stages; i += lanes) {
    const Rows<stages, Lanes> rows(w + i);
    for (std::ptrdiff_t m = 0; m < s.n; ++m) hn::StoreU(rows.sum(s.rates + stages * m), d, out + stages * m + i);
  }
}

/// Sizes compare as their bits do, and what is no number is larger than all.
template <class D> using BitsOf = hn::RebindToSigned<D>;
template <class D> HWY_INLINE hn::Vec<BitsOf<D>> size_of(D /*d*/, hn::Vec<D> x) {
  return hn::BitCast(BitsOf<D>(), hn::Abs(x));
}
template <class D> HWY_INLINE double largest_of(D d, hn::Vec<BitsOf<D>> sizes) {
  return hn::GetLane(hn::BitCast(d, hn::MaxOfLanes(BitsOf<D>(), sizes)));
}
HWY_INLINE Bits size_of(Vector x) { return size_of(Lanes(), x); }

std::uint8_t moved(std::ptrdiff_t n, const double* q, double* known) {
  const Lanes d;
  unsigned all = 0;
  for (std::ptrdiff_t lane = 0; lane < stages; lane += lanes) {
    auto same = hn::Eq(hn::Zero(d), hn::Zero(d));
    for (std::ptrdiff_t at = lane; at < stages * n; at += stages) {
      const Vector x = hn::LoadU(d, q + at);
      same = hn::And(same, hn::Eq(x, hn::LoadU(d, known + at)));  // never of what is no number
      hn::StoreU(x, d, known + at);
    }
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::Not(same), bits);
    all |= (bits[0] & ((1U << lanes) - 1)) << lane;
  }
  return static_cast<std::uint8_t>(all);
}

void take(std::ptrdiff_t n, const double* fresh, double* rates, double* change, double* size) {
  const Lanes d;
  Bits most = hn::Zero(BitLanes()), largest = most;
  for (std::ptrdiff_t k = 0; k < stages * n; k += lanes) {
    const Vector x = hn::LoadU(d, fresh + k);
    most = hn::Max(most, size_of(hn::Sub(x, hn::LoadU(d, rates + k))));
    largest = hn::Max(largest, size_of(x));
    hn::StoreU(x, d, rates + k);
  }
  *change = largest_of(d, most);
  *size = largest_of(d, largest);
}

/// In vectors of `count` lanes or fewer: where no more are asked for, wider ones would do their work in vain.
template <int count>
void take_combined_of(const StageSums& s, const double* w, double* into, double* change, double* size) {
  const hn::CappedTag<double, count> d;
  using D = hn::CappedTag<double, count>;
  auto most = hn::Zero(BitsOf<D>()), largest = most;
  for (std::ptrdiff_t i = 0; i < count; i += static_cast<std::ptrdiff_t>(hn::MaxLanes(d))) {
    const Rows<stages, D> rows(w + i);
    for (std::ptrdiff_t m = 0; m < s.n; ++m) {
      const auto sum = rows.sum(s.rates + stages * m);
      double* const at = into + stages * m + i;
      most = hn::Max(most, size_of(d, hn::Sub(sum, hn::LoadU(d, at))));
      largest = hn::Max(largest, size_of(d, sum));
      hn::StoreU(sum, d, at);
    }
  }
  *change = largest_of(d, most);
  *size = largest_of(d, largest);
}
void take_combined(const StageSums& sums, const double* w, double* into, double* change, double* size) {
  const StageSums s = sums;
  s.terms <= 4 ? take_combined_of<4>(s, w, into, change, size) : take_combined_of<8>(s, w, into, change, size);
}

#if HWY_TARGET == HWY_SCALAR

struct Weights {
  const double* of;
  explicit Weights(const double* w) : of(w) {}
};

/// The rates of one variable.
class Variables {
 public:
  explicit Variables(const double* rates) : rates_(rates) {}
  Vector sum(const Weights& w) const {
    double total = w.of[0] * rates_[0];
    for (int k = 1; k < stages; ++k) total += w.of[k] * rates_[k];
    return hn::Set(Lanes(), total);
  }
  Vector largest() const {
    const Lanes d;
    Bits most = size_of(hn::Set(d, rates_[0]));
    for (int k = 1; k < stages; ++k) most = hn::Max(most, size_of(hn::Set(d, rates_[k])));
    return hn::BitCast(d, most);
  }

 private:
  const double* rates_;
};

#else

/// Eight coefficients as `Variables` wants them: w_k and w_(k+4) by turns.
struct Weights {
  Vector of[4];
  explicit HWY_INLINE Weights(const double* w) {
    const Lanes d;
    for (int k = 0; k < 4; ++k) of[k] = hn::InterleaveLower(d, hn::Set(d, w[k]), hn::Set(d, w[k + 4]));
  }
};

/// The rates of `lanes` variables: of each half of them four vectors, where a variable has its stages k and k + 4 side
/// by side in vector k.
class Variables {
 public:
  explicit HWY_INLINE Variables(const double* rates) {
    const Lanes d;
    for (auto& [a, b, c, e] : half_) {
      hn::LoadInterleaved4(d, rates, a, b, c, e);
      rates += 4 * lanes;
    }
  }
  /// sum_k w_k F_k, a variable in each lane.
  HWY_INLINE Vector sum(const Weights& w) const {
    Vector total[2];
    for (int half = 0; half < 2; ++half) {
      total[half] = hn::Mul(w.of[0], half_[half][0]);
      for (int k = 1; k < 4; ++k) total[half] = hn::MulAdd(w.of[k], half_[half][k], total[half]);
    }
    const Lanes d;
    return hn::Add(hn::ConcatEven(d, total[1], total[0]), hn::ConcatOdd(d, total[1], total[0]));
  }
  /// max_k |F_k| likewise.
  HWY_INLINE Vector largest() const {
    Vector most[2];
    for (int half = 0; half < 2; ++half) {
      Bits sizes = size_of(half_[half][0]);
      for (int k = 1; k < 4; ++k) sizes = hn::Max(sizes, size_of(half_[half][k]));
      most[half] = hn::BitCast(Lanes(), sizes);
    }
    const Lanes d;
    const Vector even = hn::ConcatEven(d, most[1], most[0]), odd = hn::ConcatOdd(d, most[1], most[0]);
    return hn::BitCast(d, hn::Max(size_of(even), size_of(odd)));
  }

 private:
  Vector half_[2][4];
};

#endif

void coefficient(std::ptrdiff_t n, const double* rates, const double* w, double* sum, double* largest) {
  const Lanes d;
  const Weights weights(w);
  for (std::ptrdiff_t m = 0; m < n; m += lanes) {
    const Variables variables(rates + stages * m);
    hn::StoreU(variables.sum(weights), d, sum + m);
    hn::StoreU(variables.largest(), d, largest + m);
  }
}

/// A variable in each lane.
void finish(const StepSums& sums) {
  const Lanes d;
  const StepSums s = sums;
  const Vector h = hn::Set(d, s.h), h2 = hn::Set(d, s.h2), h2_low = hn::Set(d, s.h2_low);
  const Weights weights(s.weights), weights_low(s.weights_low), twice(s.twice), twice_low(s.twice_low);
  for (std::ptrdiff_t m = 0; m < s.n; m += lanes) {
    const std::ptrdiff_t count = s.n - m < lanes ? s.n - m : lanes;
    const Variables variables(s.rates + stages * m);
    if (s.q != nullptr) {
      const Vector v = load_first(d, s.v + m, count), hv = hn::Mul(h, v);
      const Vector lower = hn::MulAdd(h, load_first(d, s.v_low + m, count), fused_product_error(d, h, v, hv));
      const Vector sum = variables.sum(twice), small = hn::MulAdd(h2_low, sum, lower);
      const Vector bend = hn::MulAdd(h2, sum, hn::MulAdd(h2, variables.sum(twice_low), small));
      add_with_error(d, s.q + m, s.q_low + m, count, hv, bend);
    }
    const Vector slope = variables.sum(weights), kick = hn::Mul(h, slope);
    const Vector small = hn::MulAdd(h, variables.sum(weights_low), fused_product_error(d, h, slope, kick));
    add_with_error(d, s.v + m, s.v_low + m, count, kick, small);
  }
}

}  // namespace

extern const CollocationKernels collocation_kernels;
const CollocationKernels collocation_kernels{values, positions,     extrapolation, combine, moved,
                                             take,   take_combined, coefficient,   finish};

}  // namespace noether::NOETHER_SIMD_LEVEL

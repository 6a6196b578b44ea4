#include "engine/moments_simd.hpp"

#include <hwy/highway.h>

#include <cstdint>

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::ScalableTag<double>;
using Vector = hn::Vec<Lanes>;
constexpr std::ptrdiff_t lanes = hn::MaxLanes(Lanes());

/// A number and what its rounding has left out.
struct Wide {
  Vector high, low;
};

#if HWY_NATIVE_FMA

HWY_INLINE Wide product(Vector a, Vector b) {
  const Vector p = hn::Mul(a, b);
  return {p, hn::MulSub(a, b, p)};
}

#else

/// The nearest number of 26 bits, what is left has 26 too.
HWY_INLINE Vector upper_half(Vector a) {
  const hn::RebindToUnsigned<Lanes> words;
  const auto rounded = hn::Add(hn::BitCast(words, a), hn::Set(words, std::uint64_t{1} << 26U));
  return hn::BitCast(Lanes(), hn::AndNot(hn::Set(words, (std::uint64_t{1} << 27U) - 1), rounded));
}

HWY_INLINE Wide product(Vector a, Vector b) {
  const Vector p = hn::Mul(a, b), a1 = upper_half(a), a2 = hn::Sub(a, a1), b1 = upper_half(b), b2 = hn::Sub(b, b1);
  const Vector across = hn::Add(hn::Add(hn::Sub(hn::Mul(a1, b1), p), hn::Mul(a1, b2)), hn::Mul(a2, b1));
  return {p, hn::Add(across, hn::Mul(a2, b2))};
}

#endif

/// A sum that keeps what rounding leaves out of it beside itself.
template <class D> struct Sum {
  hn::Vec<D> high, low;

  HWY_INLINE void add(hn::Vec<D> p, hn::Vec<D> p_low) {
    const auto s = hn::Add(high, p), of_p = hn::Sub(s, high);
    const auto lost = hn::Add(hn::Sub(high, hn::Sub(s, of_p)), hn::Sub(p, of_p));
    low = hn::Add(low, hn::Add(lost, p_low));
    high = s;
  }
};

/// Adds the halves of the lanes until one is left.
HWY_INLINE void gather(hn::CappedTag<double, 1> /*one*/, const Sum<hn::CappedTag<double, 1>>& sum, double& high,
                       double& low) {
  high = hn::GetLane(sum.high);
  low = hn::GetLane(sum.low);
}
#if HWY_TARGET != HWY_SCALAR
template <class D> HWY_INLINE void gather(D /*lanes*/, const Sum<D>& sum, double& high, double& low) {
  using Half = hn::Half<D>;
  const Half half;
  Sum<Half> both{hn::LowerHalf(half, sum.high), hn::LowerHalf(half, sum.low)};
  both.add(hn::UpperHalf(half, sum.high), hn::UpperHalf(half, sum.low));
  gather(half, both, high, low);
}
#endif

/// Sums along the three axes.
struct Sums {
  Sum<Lanes> axis[3];

  HWY_INLINE void add(const Sums& other) {
    for (int k = 0; k < 3; ++k) axis[k].add(other.axis[k].high, other.axis[k].low);
  }
};

/// The first `count` numbers of a column, and zeros.
HWY_INLINE Vector load_some(const double* column, std::ptrdiff_t count) {
  const Lanes d;
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET <= HWY_AVX3
  return hn::MaskedLoad(hn::FirstN(d, static_cast<std::size_t>(count)), d, column);
#else  // others read all, and forget some
  double some[lanes] = {};
  for (std::ptrdiff_t k = 0; k < count; ++k) some[k] = column[k];
  return hn::LoadU(d, some);
#endif
}

/// Sums what `terms(load)` gives for every register of particles, where `load` reads a column.
template <class Terms> HWY_INLINE void sum_registers(std::ptrdiff_t count, const Terms& terms, WideSums& sums) {
  const Lanes d;
  std::ptrdiff_t i = count % lanes;
  Sums all = terms([&](const double* column) HWY_ATTR { return load_some(column, count % lanes); });
  for (; i < count; i += lanes) {
    all.add(terms([&](const double* column) HWY_ATTR { return hn::LoadU(d, column + i); }));
  }
  for (int k = 0; k < 3; ++k) gather(d, all.axis[k], sums.high[k], sums.low[k]);
}

void weighted(const WeightedVectors& vectors, WideSums& sums) {
  const auto terms = [&](const auto& load) HWY_ATTR {
    const Vector m = load(vectors.mass);
    Sums all;
    for (int k = 0; k < 3; ++k) {
      const Wide p = product(m, load(vectors.x[k]));
      all.axis[k] = {p.high, p.low};
    }
    return all;
  };
  sum_registers(vectors.count, terms, sums);
}

void crossed(const WeightedVectors& velocities, const double* const (&x)[3], WideSums& sums) {
  const auto moment = [](Vector distance, const Wide& momentum) HWY_ATTR {
    const Wide q = product(distance, momentum.high);
    return Wide{q.high, hn::Add(q.low, hn::Mul(distance, momentum.low))};
  };
  const auto terms = [&](const auto& load) HWY_ATTR {
    const Vector m = load(velocities.mass);
    Vector at[3];
    Wide p[3];
    for (int k = 0; k < 3; ++k) {
      at[k] = load(x[k]);
      p[k] = product(m, load(velocities.x[k]));
    }
    Sums all;
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      const Wide one = moment(at[a], p[b]), other = moment(hn::Neg(at[b]), p[a]);
      all.axis[k] = {one.high, one.low};
      all.axis[k].add(other.high, other.low);
    }
    return all;
  };
  sum_registers(velocities.count, terms, sums);
}

}  // namespace

extern const MomentKernels moment_kernels;
constinit const MomentKernels moment_kernels{weighted, crossed};

}  // namespace noether::NOETHER_SIMD_LEVEL

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
struct Sum {
  Vector high, low;

  HWY_INLINE void add(Vector p, Vector p_low) {
    const auto s = hn::Add(high, p), of_p = hn::Sub(s, high);
    const auto lost = hn::Add(hn::Sub(high, hn::Sub(s, of_p)), hn::Sub(p, of_p));
    low = hn::Add(low, hn::Add(lost, p_low));
    high = s;
  }
};

/// Sums along the three axes.
struct Sums {
  Sum axis[3];

  HWY_INLINE void add(const Sums& other) {
    for (int k = 0; k < 3; ++k) axis[k].add(other.axis[k].high, other.axis[k].low);
  }
};

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE void store_totals(const Sums& all, WideSums& sums) {
  for (int k = 0; k < 3; ++k) {
    sums.high[k] = hn::GetLane(all.axis[k].high);
    sums.low[k] = hn::GetLane(all.axis[k].low);
  }
}

#else

/// Neighbouring lanes added, those of `a` in the lower half of the register and those of `b` in the upper one.
HWY_INLINE Sum pairs(const Sum& a, const Sum& b) {
  const Lanes d;
  Sum both{hn::ConcatEven(d, b.high, a.high), hn::ConcatEven(d, b.low, a.low)};
  both.add(hn::ConcatOdd(d, b.high, a.high), hn::ConcatOdd(d, b.low, a.low));
  return both;
}

/// Writes as many lanes as three sums have room for.
template <class D> HWY_INLINE void store_row(D d, hn::Vec<D> row, double* to) {
  if constexpr (hn::MaxLanes(D()) > 4) {
    const hn::Half<D> half;
    store_row(half, hn::LowerHalf(half, row), to);
  } else {
    hn::StoreU(row, d, to);
  }
}

/// Adds the lanes of each axis; all axes share a register as soon as they fit in.
HWY_INLINE void store_totals(const Sums& all, WideSums& sums) {
  const auto store = [&](const Sum& totals, int axis) HWY_ATTR {
    store_row(Lanes(), totals.high, sums.high + axis);
    store_row(Lanes(), totals.low, sums.low + axis);
  };
  const Sum xy = pairs(all.axis[0], all.axis[1]), z = pairs(all.axis[2], all.axis[2]);
  if constexpr (lanes == 2) {
    store(xy, 0);
    store(z, 2);
  } else {
    Sum xyz = pairs(xy, z);
    for (std::ptrdiff_t joined = 4; joined < lanes; joined *= 2) xyz = pairs(xyz, xyz);
    store(xyz, 0);
  }
}

#endif

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
  store_totals(all, sums);
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

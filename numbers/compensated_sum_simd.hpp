#pragma once
/// Compensated sums in lanes of doubles; for `*_simd.cpp` alone.

#include <hwy/highway.h>

#include <cstddef>

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// The first `count` numbers, or as many as there are lanes; the rest is 0.
template <class D> HWY_INLINE hn::Vec<D> load_first(D d, const double* from, std::ptrdiff_t count) {
  constexpr std::ptrdiff_t lanes = hn::MaxLanes(D());
  if (count >= lanes) return hn::LoadU(d, from);
#if HWY_TARGET <= HWY_AVX2
  return hn::MaskedLoad(hn::FirstN(d, static_cast<std::size_t>(count)), d, from);
#else
  double padded[lanes] = {};
  for (std::ptrdiff_t k = 0; k < count; ++k) padded[k] = from[k];
  return hn::LoadU(d, padded);
#endif
}

template <class D> HWY_INLINE void store_first(D d, hn::Vec<D> x, double* to, std::ptrdiff_t count) {
  constexpr std::ptrdiff_t lanes = hn::MaxLanes(D());
  if (count >= lanes) return hn::StoreU(x, d, to);
#if HWY_TARGET <= HWY_AVX2
  hn::BlendedStore(x, hn::FirstN(d, static_cast<std::size_t>(count)), d, to);
#else
  double padded[lanes];
  hn::StoreU(x, d, padded);
  for (std::ptrdiff_t k = 0; k < count; ++k) to[k] = padded[k];
#endif
}

/// a + b, rounded, with what rounding takes from it.
template <class V> struct SumWithError {
  V sum, lost;

  HWY_INLINE SumWithError(V a, V b) : sum(hn::Add(a, b)) {
    const V back = hn::Sub(sum, a);
    lost = hn::Add(hn::Sub(a, hn::Sub(sum, back)), hn::Sub(b, back));
  }
};

/// What rounding takes from the product of a and b, where the processor can tell; elsewhere 0.
template <class D>
HWY_INLINE hn::Vec<D> fused_product_error([[maybe_unused]] D d, [[maybe_unused]] hn::Vec<D> a,
                                          [[maybe_unused]] hn::Vec<D> b, [[maybe_unused]] hn::Vec<D> product) {
#if HWY_NATIVE_FMA
  return hn::MulSub(a, b, product);
#else
  return hn::Zero(d);
#endif
}

/// value + low = sum + rest + low for the first `count` numbers, where the rest is smaller than the sum.
template <class D>
HWY_INLINE void end_sum(D d, double* value, double* low, std::ptrdiff_t count, hn::Vec<D> sum, hn::Vec<D> lost,
                        hn::Vec<D> small) {
  const hn::Vec<D> rest = hn::Add(lost, hn::Add(small, load_first(d, low, count)));
  const hn::Vec<D> after = hn::Add(sum, rest);
  store_first(d, after, value, count);
  store_first(d, hn::Sub(rest, hn::Sub(after, sum)), low, count);
}

/// value + low += high + small for the first `count` numbers, where `high` may be as large as the value.
template <class D>
HWY_INLINE void add_with_error(D d, double* value, double* low, std::ptrdiff_t count, hn::Vec<D> high,
                               hn::Vec<D> small) {
  const SumWithError<hn::Vec<D>> first(load_first(d, value, count), high);
  end_sum(d, value, low, count, first.sum, first.lost, small);
}

/// The same with a second term whose rounding is kept: value + low += high + next + small.
template <class D>
HWY_INLINE void add_with_errors(D d, double* value, double* low, std::ptrdiff_t count, hn::Vec<D> high, hn::Vec<D> next,
                                hn::Vec<D> small) {
  const SumWithError<hn::Vec<D>> first(load_first(d, value, count), high), second(first.sum, next);
  end_sum(d, value, low, count, second.sum, hn::Add(first.lost, second.lost), small);
}

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL

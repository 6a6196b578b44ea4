#pragma once
/// 1 / sqrt(x), and its cube, in lanes of doubles; for `*_simd.cpp` alone.

#include <hwy/highway.h>

#include <cstdint>

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_AVX2 || HWY_TARGET <= HWY_AVX3

/// h_k = 1 - x_k y_k^2.
template <class D, class V, int n> HWY_INLINE void deviation(D d, const V (&x)[n], const V (&y)[n], V (&h)[n]) {
  for (int k = 0; k < n; ++k) h[k] = hn::Mul(x[k], y[k]);
  for (int k = 0; k < n; ++k) h[k] = hn::NegMulAdd(h[k], y[k], hn::Set(d, 1.0));
}

/// One step of Horner's rule for n numbers side by side.
template <class D, class V, int n> HWY_INLINE void times(D d, const V (&h)[n], double coefficient, V (&series)[n]) {
  for (int k = 0; k < n; ++k) series[k] = hn::MulAdd(series[k], h[k], hn::Set(d, coefficient));
}

/// y_k near 1 / sqrt(x_k), to 7.7e-7, with the same bits on every processor: a seed from the exponent, and one step.
template <class D, class V, int n> HWY_INLINE void integer_seed(D d, const V (&x)[n], V (&y)[n]) {
  const hn::RebindToUnsigned<D> bits;
  const auto magic = hn::Set(bits, std::uint64_t{0x5FE6EB50C7B537A9});
  for (int k = 0; k < n; ++k) {
    y[k] = hn::BitCast(d, hn::Sub(magic, hn::ShiftRight<1>(hn::BitCast(bits, x[k]))));
  }
  // Here -0.0692 < h < 0.0676. Interpolated in the Chebyshev nodes of that interval.
  V h[n], series[n];
  deviation(d, x, y, h);
  for (int k = 0; k < n; ++k) series[k] = hn::Set(d, 0.3127981123559105);
  times(d, h, 0.376278137350681, series);
  times(d, h, 0.500001318508243, series);
  times(d, h, 0.9999992549645748, series);
  for (int k = 0; k < n; ++k) y[k] = hn::Mul(y[k], series[k]);
}

/// y_k near 1 / sqrt(x_k): by the processor's seed of 14 bits, or by `integer_seed`.
template <class D, class V, int n> HWY_INLINE void seed(D d, const V (&x)[n], V (&y)[n]) {
#if HWY_TARGET == HWY_AVX2
  integer_seed(d, x, y);
#else
  static_cast<void>(d);
  for (int k = 0; k < n; ++k) y[k] = V{_mm512_rsqrt14_pd(x[k].raw)};
#endif
}

/// u_k = 1 / sqrt(x_k), to 2 ulp, for normal x_k above 0 whose root has a normal reciprocal.
///
/// A seed y, then the series of  y (1 - h)^(-1/2)  with  h = 1 - x y^2. The n numbers go side by side, since each step
/// waits for the one before.
/// @source Robertson2012
template <class D, class V, int n> HWY_INLINE void reciprocal_sqrt(D d, const V (&x)[n], V (&u)[n]) {
  V h[n], series[n];
  seed(d, x, u);
  deviation(d, x, u, h);  // of the processor's seed below 1.3e-4: the next term of the series would be below 7e-17
#if HWY_TARGET == HWY_AVX2
  for (int k = 0; k < n; ++k) series[k] = hn::Set(d, 0.375);
#else
  for (int k = 0; k < n; ++k) series[k] = hn::Set(d, 0.3125);
  times(d, h, 0.375, series);
#endif
  times(d, h, 0.5, series);
  for (int k = 0; k < n; ++k) h[k] = hn::Mul(u[k], h[k]);
  for (int k = 0; k < n; ++k) u[k] = hn::MulAdd(h[k], series[k], u[k]);
}

/// c_k = x_k^(-3/2), rounded once but for a thousandth of an ulp, for normal x_k above 0 where that is normal.
///
/// A seed y of 17 bits, so that y^2 and y^3 are exact and h = 1 - x y^2 is known to its own last bit, then the series
/// of  y^3 (1 - h)^(-3/2).
template <class D, class V, int n> HWY_INLINE void reciprocal_cube(D d, const V (&x)[n], V (&c)[n]) {
  const hn::RebindToUnsigned<D> bits;
  const auto upper = hn::Set(bits, ~std::uint64_t{(std::uint64_t{1} << 36U) - 1});
  V y[n], h[n], series[n];
  seed(d, x, y);
  for (int k = 0; k < n; ++k) y[k] = hn::BitCast(d, hn::And(hn::BitCast(bits, y[k]), upper));
  for (int k = 0; k < n; ++k) h[k] = hn::Mul(y[k], y[k]);
  for (int k = 0; k < n; ++k) c[k] = hn::Mul(h[k], y[k]);
  for (int k = 0; k < n; ++k) h[k] = hn::NegMulAdd(x[k], h[k], hn::Set(d, 1.0));
#if HWY_TARGET == HWY_AVX2
  for (int k = 0; k < n; ++k) series[k] = hn::Set(d, 2.1875);
#else
  for (int k = 0; k < n; ++k) series[k] = hn::Set(d, 2.4609375);  // below 1.5e-4: the next term would be below 3e-19
  times(d, h, 2.1875, series);
#endif
  times(d, h, 1.875, series);
  times(d, h, 1.5, series);
  for (int k = 0; k < n; ++k) h[k] = hn::Mul(c[k], h[k]);
  for (int k = 0; k < n; ++k) c[k] = hn::MulAdd(h[k], series[k], c[k]);
}

#else

// Without fused multiply-add, square root and division are as quick.
template <class D, class V, int n> HWY_INLINE void reciprocal_sqrt(D d, const V (&x)[n], V (&u)[n]) {
  for (int k = 0; k < n; ++k) u[k] = hn::Div(hn::Set(d, 1.0), hn::Sqrt(x[k]));
}
template <class D, class V, int n> HWY_INLINE void reciprocal_cube(D d, const V (&x)[n], V (&c)[n]) {
  for (int k = 0; k < n; ++k) c[k] = hn::Div(hn::Set(d, 1.0), hn::Mul(x[k], hn::Sqrt(x[k])));
}

#endif

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL

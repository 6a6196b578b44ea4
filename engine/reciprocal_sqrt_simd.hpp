#pragma once
/// 1 / sqrt(x) in lanes of doubles; for `*_simd.cpp` alone.

#include <hwy/highway.h>

#include <cstdint>

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// u_k = 1 / sqrt(x_k), to 2 ulp, for normal x_k above 0 whose root has a normal reciprocal.
///
/// A seed y, then the series of  y (1 - h)^(-1/2)  with  h = 1 - x y^2: one step behind the processor's seed of 14
/// bits, two behind one made from the exponent. The n numbers go side by side, since each step waits for the one
/// before. Without fused multiply-add, square root and division are as quick.
/// @source Robertson2012
template <class D, class V, int n> HWY_INLINE void reciprocal_sqrt(D d, const V (&x)[n], V (&u)[n]) {
  const V one = hn::Set(d, 1.0);
#if HWY_TARGET != HWY_AVX2 && HWY_TARGET > HWY_AVX3
  for (int k = 0; k < n; ++k) u[k] = hn::Div(one, hn::Sqrt(x[k]));
#else
  V h[n], series[n];
  const auto deviation = [&] {
    for (int k = 0; k < n; ++k) h[k] = hn::Mul(x[k], u[k]);
    for (int k = 0; k < n; ++k) h[k] = hn::NegMulAdd(h[k], u[k], one);
  };
  const auto times = [&](double coefficient) {
    for (int k = 0; k < n; ++k) series[k] = hn::MulAdd(series[k], h[k], hn::Set(d, coefficient));
  };
#if HWY_TARGET == HWY_AVX2
  const hn::RebindToUnsigned<D> bits;
  const auto magic = hn::Set(bits, std::uint64_t{0x5FE6EB50C7B537A9});
  for (int k = 0; k < n; ++k) {
    u[k] = hn::BitCast(d, hn::Sub(magic, hn::ShiftRight<1>(hn::BitCast(bits, x[k]))));
  }
  // Here -0.0692 < h < 0.0676. Interpolated in the Chebyshev nodes of that interval: wrong by 7.7e-7 at most.
  deviation();
  for (int k = 0; k < n; ++k) series[k] = hn::Set(d, 0.3127981123559105);
  times(0.376278137350681);
  times(0.500001318508243);
  times(0.9999992549645748);
  for (int k = 0; k < n; ++k) u[k] = hn::Mul(u[k], series[k]);
  deviation();
  for (int k = 0; k < n; ++k) series[k] = hn::Set(d, 0.375);
#else
  for (int k = 0; k < n; ++k) u[k] = V{_mm512_rsqrt14_pd(x[k].raw)};
  deviation();  // below 1.3e-4: the next term of the series would be below 7e-17
  for (int k = 0; k < n; ++k) series[k] = hn::Set(d, 0.3125);
  times(0.375);
#endif
  times(0.5);
  for (int k = 0; k < n; ++k) h[k] = hn::Mul(u[k], h[k]);
  for (int k = 0; k < n; ++k) u[k] = hn::MulAdd(h[k], series[k], u[k]);
#endif
}

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL

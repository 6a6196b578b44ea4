#pragma once
/// Eight doubles side by side in the registers of a level: one, two or four of them. For `*_simd.cpp` alone.
///
/// There are only operations that IEEE 754 defines, none of them fused, and sums over lanes have one order. So a
/// kernel made of these has the same bits at every level and on every processor.

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#define NOETHER_EIGHT_INLINE [[gnu::always_inline]] inline

#if !defined(NOETHER_EIGHT_REGISTERS)  // a test has one level walk the way of another
#if defined(__AVX512F__)
#define NOETHER_EIGHT_REGISTERS 1
#elif defined(__AVX2__)
#define NOETHER_EIGHT_REGISTERS 2
#else
#define NOETHER_EIGHT_REGISTERS 4
#endif
#endif

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

constexpr int eight_registers = NOETHER_EIGHT_REGISTERS, eight_width = 8 / eight_registers;
typedef double EightRegister __attribute__((vector_size(64 / NOETHER_EIGHT_REGISTERS), may_alias));
typedef long long EightBits __attribute__((vector_size(64 / NOETHER_EIGHT_REGISTERS), may_alias));

struct Eight {
  EightRegister r[eight_registers];

  Eight() = default;
  NOETHER_EIGHT_INLINE Eight(double x) {  // NOLINT: a number stands for eight of it
    for (auto& one : r) one = x - EightRegister{};
  }
};

/// f(k) in register k.
template <class F> NOETHER_EIGHT_INLINE Eight eight_of(const F& f) {
  Eight e;
  e.r[0] = f(0);
  if constexpr (eight_registers > 1) e.r[1] = f(1);
  if constexpr (eight_registers > 2) e.r[2] = f(2), e.r[3] = f(3);
  return e;
}

NOETHER_EIGHT_INLINE Eight load_eight(const double* from) {  // aligned
  return eight_of([&](int k) { return *reinterpret_cast<const EightRegister*>(from + eight_width * k); });
}
NOETHER_EIGHT_INLINE void store_eight(const Eight& a, double* to) {
  for (int k = 0; k < eight_registers; ++k) *reinterpret_cast<EightRegister*>(to + eight_width * k) = a.r[k];
}

NOETHER_EIGHT_INLINE Eight operator+(const Eight& a, const Eight& b) {
  return eight_of([&](int k) { return a.r[k] + b.r[k]; });
}
NOETHER_EIGHT_INLINE Eight operator-(const Eight& a, const Eight& b) {
  return eight_of([&](int k) { return a.r[k] - b.r[k]; });
}
NOETHER_EIGHT_INLINE Eight operator*(const Eight& a, const Eight& b) {
  return eight_of([&](int k) { return a.r[k] * b.r[k]; });
}
NOETHER_EIGHT_INLINE Eight operator/(const Eight& a, const Eight& b) {
  return eight_of([&](int k) { return a.r[k] / b.r[k]; });
}
NOETHER_EIGHT_INLINE EightRegister root_of(const EightRegister& a) {
#if defined(__AVX512F__) && NOETHER_EIGHT_REGISTERS == 1
  return EightRegister(_mm512_maskz_sqrt_pd(0xff, a));
#elif defined(__AVX2__) && NOETHER_EIGHT_REGISTERS == 2
  return EightRegister(_mm256_sqrt_pd(a));
#elif defined(__SSE2__) && NOETHER_EIGHT_REGISTERS == 4
  return EightRegister(_mm_sqrt_pd(a));
#else
  EightRegister root{};
  for (int i = 0; i < eight_width; ++i) root[i] = __builtin_sqrt(a[i]);
  return root;
#endif
}
NOETHER_EIGHT_INLINE Eight square_root(const Eight& a) {
  return eight_of([&](int k) { return root_of(a.r[k]); });
}
NOETHER_EIGHT_INLINE Eight absolute(const Eight& a) {
  return eight_of([&](int k) { return EightRegister(EightBits(a.r[k]) & (EightBits{} + 0x7fffffffffffffffLL)); });
}
/// The smaller one of each lane; b where one is not a number.
NOETHER_EIGHT_INLINE Eight smaller(const Eight& a, const Eight& b) {
  return eight_of([&](int k) { return a.r[k] < b.r[k] ? a.r[k] : b.r[k]; });
}
/// The larger one of each lane; b where one is not a number.
NOETHER_EIGHT_INLINE Eight larger(const Eight& a, const Eight& b) {
  return eight_of([&](int k) { return a.r[k] > b.r[k] ? a.r[k] : b.r[k]; });
}
/// A bit for each lane where a <= b does not hold.
NOETHER_EIGHT_INLINE unsigned exceeding(const Eight& a, const Eight& b) {
  unsigned lanes = 0;
  for (int k = 0; k < eight_registers; ++k) {
#if defined(__AVX512F__) && NOETHER_EIGHT_REGISTERS == 1
    lanes = _mm512_cmp_pd_mask(a.r[k], b.r[k], _CMP_NLE_UQ);
#elif defined(__AVX2__) && NOETHER_EIGHT_REGISTERS == 2
    lanes |= unsigned(_mm256_movemask_pd(_mm256_cmp_pd(a.r[k], b.r[k], _CMP_NLE_UQ))) << (eight_width * k);
#elif defined(__SSE2__) && NOETHER_EIGHT_REGISTERS == 4
    lanes |= unsigned(_mm_movemask_pd(_mm_cmpnle_pd(a.r[k], b.r[k]))) << (eight_width * k);
#else
    for (int i = 0; i < eight_width; ++i) lanes |= unsigned(!(a.r[k][i] <= b.r[k][i])) << (eight_width * k + i);
#endif
  }
  return lanes;
}

#if NOETHER_EIGHT_REGISTERS == 1

/// Lane i takes what lane i + n has, in a ring.
template <int n> NOETHER_EIGHT_INLINE Eight rotate(const Eight& a) {
  constexpr int m = n & 7;
  return eight_of([&](int) {
    return EightRegister(__builtin_shufflevector(a.r[0], a.r[0], m, m + 1, m + 2, m + 3, m + 4, m + 5, m + 6, m + 7));
  });
}
/// Lane i becomes the sum of lanes 0 to i.
NOETHER_EIGHT_INLINE Eight sums_upward(const Eight& a) {
  const EightRegister zero{};
  EightRegister x = a.r[0];
  x += __builtin_shufflevector(x, zero, 8, 0, 8, 2, 8, 4, 8, 6);
  x += __builtin_shufflevector(x, zero, 8, 8, 1, 1, 8, 8, 5, 5);
  x += __builtin_shufflevector(x, zero, 8, 8, 8, 8, 3, 3, 3, 3);
  return eight_of([&](int) { return x; });
}
/// Lane i becomes the sum of lanes i to 7.
NOETHER_EIGHT_INLINE Eight sums_downward(const Eight& a) {
  const EightRegister zero{};
  EightRegister x = a.r[0];
  x += __builtin_shufflevector(x, zero, 1, 8, 3, 8, 5, 8, 7, 8);
  x += __builtin_shufflevector(x, zero, 2, 2, 8, 8, 6, 6, 8, 8);
  x += __builtin_shufflevector(x, zero, 4, 4, 4, 4, 8, 8, 8, 8);
  return eight_of([&](int) { return x; });
}
/// The sum of all lanes in each.
NOETHER_EIGHT_INLINE Eight sum_of_lanes(const Eight& a) {
  EightRegister x = a.r[0];
  x += __builtin_shufflevector(x, x, 4, 5, 6, 7, 0, 1, 2, 3);
  x += __builtin_shufflevector(x, x, 1, 0, 3, 2, 5, 4, 7, 6);
  x += __builtin_shufflevector(x, x, 2, 3, 0, 1, 6, 7, 4, 5);
  return eight_of([&](int) { return x; });
}
/// One lane in each.
NOETHER_EIGHT_INLINE Eight first_lane(const Eight& a) {
  return eight_of([&](int) { return EightRegister(__builtin_shufflevector(a.r[0], a.r[0], 0, 0, 0, 0, 0, 0, 0, 0)); });
}
NOETHER_EIGHT_INLINE Eight last_lane(const Eight& a) {
  return eight_of([&](int) { return EightRegister(__builtin_shufflevector(a.r[0], a.r[0], 7, 7, 7, 7, 7, 7, 7, 7)); });
}

#elif NOETHER_EIGHT_REGISTERS == 2

template <int n> NOETHER_EIGHT_INLINE Eight rotate(const Eight& a) {
  constexpr int m = n & 7;
  const EightRegister low = m < 4 ? a.r[0] : a.r[1], high = m < 4 ? a.r[1] : a.r[0];
  const EightRegister up = _mm256_permute2f128_pd(low, high, 0x21), down = _mm256_permute2f128_pd(high, low, 0x21);
  Eight e;
  if constexpr ((m & 3) == 0) e.r[0] = low, e.r[1] = high;
  if constexpr ((m & 3) == 1) e.r[0] = _mm256_shuffle_pd(low, up, 5), e.r[1] = _mm256_shuffle_pd(high, down, 5);
  if constexpr ((m & 3) == 2) e.r[0] = up, e.r[1] = down;
  if constexpr ((m & 3) == 3) e.r[0] = _mm256_shuffle_pd(up, high, 5), e.r[1] = _mm256_shuffle_pd(down, low, 5);
  return e;
}
NOETHER_EIGHT_INLINE Eight sums_upward(const Eight& a) {
  const EightRegister zero{};
  Eight e = eight_of([&](int k) {
    const EightRegister x = a.r[k] + EightRegister(_mm256_unpacklo_pd(zero, a.r[k]));
    return x + EightRegister(_mm256_blend_pd(zero, _mm256_permute4x64_pd(x, 0x55), 0xc));
  });
  e.r[1] += EightRegister(_mm256_permute4x64_pd(e.r[0], 0xff));
  return e;
}
NOETHER_EIGHT_INLINE Eight sums_downward(const Eight& a) {
  const EightRegister zero{};
  Eight e = eight_of([&](int k) {
    const EightRegister x = a.r[k] + EightRegister(_mm256_unpackhi_pd(a.r[k], zero));
    return x + EightRegister(_mm256_blend_pd(zero, _mm256_permute4x64_pd(x, 0xaa), 0x3));
  });
  e.r[0] += EightRegister(_mm256_permute4x64_pd(e.r[1], 0x00));
  return e;
}
NOETHER_EIGHT_INLINE Eight sum_of_lanes(const Eight& a) {
  EightRegister x = a.r[0] + a.r[1];
  x += EightRegister(_mm256_permute_pd(x, 5));
  x += EightRegister(_mm256_permute2f128_pd(x, x, 1));
  return eight_of([&](int) { return x; });
}
NOETHER_EIGHT_INLINE Eight first_lane(const Eight& a) {
  return eight_of([&](int) { return EightRegister(_mm256_permute4x64_pd(a.r[0], 0x00)); });
}
NOETHER_EIGHT_INLINE Eight last_lane(const Eight& a) {
  return eight_of([&](int) { return EightRegister(_mm256_permute4x64_pd(a.r[1], 0xff)); });
}

#else

template <int n> NOETHER_EIGHT_INLINE Eight rotate(const Eight& a) {
  constexpr int m = n & 7;
  return eight_of([&](int k) {
    const EightRegister low = a.r[(k + m / 2) & 3], high = a.r[(k + m / 2 + 1) & 3];
    return m % 2 == 0 ? low : EightRegister(__builtin_shufflevector(low, high, 1, 2));
  });
}
NOETHER_EIGHT_INLINE Eight sums_upward(const Eight& a) {
  const EightRegister zero{};
  Eight e = eight_of([&](int k) { return a.r[k] + __builtin_shufflevector(a.r[k], zero, 2, 0); });
  e.r[0] += zero;  // as where lanes that take nothing are added to 0
  e.r[1] += __builtin_shufflevector(e.r[0], e.r[0], 1, 1);
  e.r[2] += zero;
  e.r[3] += __builtin_shufflevector(e.r[2], e.r[2], 1, 1);
  const EightRegister half = __builtin_shufflevector(e.r[1], e.r[1], 1, 1);
  e.r[2] += half;
  e.r[3] += half;
  return e;
}
NOETHER_EIGHT_INLINE Eight sums_downward(const Eight& a) {
  const EightRegister zero{};
  Eight e = eight_of([&](int k) { return a.r[k] + __builtin_shufflevector(a.r[k], zero, 1, 2); });
  e.r[3] += zero;
  e.r[2] += __builtin_shufflevector(e.r[3], e.r[3], 0, 0);
  e.r[1] += zero;
  e.r[0] += __builtin_shufflevector(e.r[1], e.r[1], 0, 0);
  const EightRegister half = __builtin_shufflevector(e.r[2], e.r[2], 0, 0);
  e.r[1] += half;
  e.r[0] += half;
  return e;
}
NOETHER_EIGHT_INLINE Eight sum_of_lanes(const Eight& a) {
  EightRegister low = a.r[0] + a.r[2], high = a.r[1] + a.r[3];
  low += __builtin_shufflevector(low, low, 1, 0);
  high += __builtin_shufflevector(high, high, 1, 0);
  const EightRegister sum = low + high;
  return eight_of([&](int) { return sum; });
}
NOETHER_EIGHT_INLINE Eight first_lane(const Eight& a) {
  return eight_of([&](int) { return EightRegister(__builtin_shufflevector(a.r[0], a.r[0], 0, 0)); });
}
NOETHER_EIGHT_INLINE Eight last_lane(const Eight& a) {
  return eight_of([&](int) { return EightRegister(__builtin_shufflevector(a.r[3], a.r[3], 1, 1)); });
}

#endif

/// Vectors x, y, z of eight bodies.
struct Eights {
  Eight x, y, z;
};
NOETHER_EIGHT_INLINE Eight dot(const Eights& a, const Eights& b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
NOETHER_EIGHT_INLINE Eights operator+(const Eights& a, const Eights& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
NOETHER_EIGHT_INLINE Eights operator-(const Eights& a, const Eights& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
NOETHER_EIGHT_INLINE Eights operator*(const Eight& a, const Eights& b) { return {a * b.x, a * b.y, a * b.z}; }
/// Rotations of eight bodies as matrices, from unit quaternions: those of `rotation_matrix` to the bit.
struct EightRotations {
  Eights row[3];
};
NOETHER_EIGHT_INLINE EightRotations rotations(const Eight& w, const Eight& x, const Eight& y, const Eight& z) {
  const Eight two(2.0), ww = w * w, xx = x * x, yy = y * y, zz = z * z;
  const Eight xy = x * y, xz = x * z, yz = y * z, wx = w * x, wy = w * y, wz = w * z;
  return {{{ww + xx - yy - zz, two * (xy - wz), two * (xz + wy)},
           {two * (xy + wz), ww - xx + yy - zz, two * (yz - wx)},
           {two * (xz - wy), two * (yz + wx), ww - xx - yy + zz}}};
}
template <int n> NOETHER_EIGHT_INLINE Eights rotate(const Eights& a) {
  return {rotate<n>(a.x), rotate<n>(a.y), rotate<n>(a.z)};
}
NOETHER_EIGHT_INLINE Eights load_eights(const double (*from)[8]) {
  return {load_eight(from[0]), load_eight(from[1]), load_eight(from[2])};
}
NOETHER_EIGHT_INLINE void store_eights(const Eights& a, double (*to)[8]) {
  store_eight(a.x, to[0]);
  store_eight(a.y, to[1]);
  store_eight(a.z, to[2]);
}

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL

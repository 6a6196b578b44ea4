#pragma once
/// Double-doubles of eight bodies side by side, as `DoubleDouble` has them one by one. For `*_simd.cpp` alone.
///
/// What rounding takes from a product of doubles is a double: it is the same number, fused or by halves of the factors,
/// as long as nothing underflows. So bits are the same at every level.

#include "numbers/eight_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

/// What a b loses where it is rounded to p.
NOETHER_EIGHT_INLINE EightRegister lost_by_product(const EightRegister& a, const EightRegister& b,
                                                   const EightRegister& p) {
#if defined(__AVX512F__) && NOETHER_EIGHT_REGISTERS == 1
  return EightRegister(_mm512_fmsub_pd(a, b, p));
#elif defined(__FMA__) && NOETHER_EIGHT_REGISTERS == 2
  return EightRegister(_mm256_fmsub_pd(a, b, p));
#else
  const auto upper_half = [](const EightRegister& x) {
    return EightRegister((EightBits(x) + (1LL << 26)) & ~(EightBits{} + ((1LL << 27) - 1)));
  };
  const EightRegister a1 = upper_half(a), a2 = a - a1, b1 = upper_half(b), b2 = b - b1;
  return ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2;
#endif
}

/// high + low, the second at most a few roundings of the first. Sums leave it below one rounding.
struct EightWide {
  Eight high, low;
};

NOETHER_EIGHT_INLINE EightWide load_wide(const double (&words)[2][8]) {
  return {load_eight(words[0]), load_eight(words[1])};
}
NOETHER_EIGHT_INLINE void store_wide(const EightWide& a, double (&words)[2][8]) {
  store_eight(a.high, words[0]);
  store_eight(a.low, words[1]);
}

/// a + b and its rounding error, in any order of sizes.
NOETHER_EIGHT_INLINE EightWide exact_sum(const Eight& a, const Eight& b) {
  const Eight s = a + b, of_b = s - a;
  return {s, (a - (s - of_b)) + (b - of_b)};
}
/// The same where a is the larger one, or 0.
NOETHER_EIGHT_INLINE EightWide ordered_sum(const Eight& a, const Eight& b) {
  const Eight s = a + b;
  return {s, b - (s - a)};
}
/// a b, exactly.
NOETHER_EIGHT_INLINE EightWide exact_product(const Eight& a, const Eight& b) {
  const Eight p = a * b;
  return {p, eight_of([&](int k) { return lost_by_product(a.r[k], b.r[k], p.r[k]); })};
}
NOETHER_EIGHT_INLINE Eight negative(const Eight& a) {
  return eight_of([&](int k) { return -a.r[k]; });
}

NOETHER_EIGHT_INLINE EightWide operator-(const EightWide& a) { return {negative(a.high), negative(a.low)}; }
NOETHER_EIGHT_INLINE EightWide operator+(const EightWide& a, const EightWide& b) {
  const EightWide s = exact_sum(a.high, b.high);
  return ordered_sum(s.high, s.low + (a.low + b.low));
}
NOETHER_EIGHT_INLINE EightWide operator-(const EightWide& a, const EightWide& b) {
  const EightWide s = exact_sum(a.high, negative(b.high));
  return ordered_sum(s.high, s.low + (a.low - b.low));
}
NOETHER_EIGHT_INLINE EightWide operator+(const EightWide& a, const Eight& b) {
  const EightWide s = exact_sum(a.high, b);
  return ordered_sum(s.high, s.low + a.low);
}
/// Right to a few 2^-104 of itself.
NOETHER_EIGHT_INLINE EightWide operator*(const EightWide& a, const EightWide& b) {
  const EightWide p = exact_product(a.high, b.high);
  return {p.high, p.low + (a.high * b.low + a.low * b.high)};
}
NOETHER_EIGHT_INLINE EightWide operator*(const Eight& a, const EightWide& b) {
  const EightWide p = exact_product(a, b.high);
  return {p.high, p.low + a * b.low};
}
/// 2^n a.
NOETHER_EIGHT_INLINE EightWide scaled(const Eight& power_of_two, const EightWide& a) {
  return {power_of_two * a.high, power_of_two * a.low};
}
/// 1 / a.
NOETHER_EIGHT_INLINE EightWide reciprocal(const EightWide& a) {
  const Eight q = Eight(1.0) / a.high;
  const EightWide p = exact_product(q, a.high);
  return ordered_sum(q, q * (((Eight(1.0) - p.high) - p.low) - q * a.low));
}
NOETHER_EIGHT_INLINE EightWide square_root(const EightWide& a) {
  const Eight root = square_root(a.high);
  const EightWide square = exact_product(root, root);
  return ordered_sum(root, (((a.high - square.high) - square.low) + a.low) / (root + root));
}

/// Vectors of eight bodies.
struct EightWides {
  EightWide x, y, z;
};
NOETHER_EIGHT_INLINE EightWide dot(const EightWides& a, const EightWides& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
NOETHER_EIGHT_INLINE Eights high_words(const EightWides& a) { return {a.x.high, a.y.high, a.z.high}; }
NOETHER_EIGHT_INLINE EightWides load_wides(const double (*words)[2][8]) {
  return {load_wide(words[0]), load_wide(words[1]), load_wide(words[2])};
}

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL

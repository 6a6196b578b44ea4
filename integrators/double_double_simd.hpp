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

/// Runs of `run` lanes of a and b by turns: the even runs of both, and the odd ones.
struct EightMerged {
  Eight even, odd;
};
#if NOETHER_EIGHT_REGISTERS == 1
template <int run> NOETHER_EIGHT_INLINE EightMerged merged(const Eight& a, const Eight& b) {
  EightMerged m;
  const EightRegister &x = a.r[0], &y = b.r[0];
  if constexpr (run == 1) {
    m.even.r[0] = __builtin_shufflevector(x, y, 0, 8, 2, 10, 4, 12, 6, 14);
    m.odd.r[0] = __builtin_shufflevector(x, y, 1, 9, 3, 11, 5, 13, 7, 15);
  } else if constexpr (run == 2) {
    m.even.r[0] = __builtin_shufflevector(x, y, 0, 1, 8, 9, 4, 5, 12, 13);
    m.odd.r[0] = __builtin_shufflevector(x, y, 2, 3, 10, 11, 6, 7, 14, 15);
  } else {
    m.even.r[0] = __builtin_shufflevector(x, y, 0, 1, 2, 3, 8, 9, 10, 11);
    m.odd.r[0] = __builtin_shufflevector(x, y, 4, 5, 6, 7, 12, 13, 14, 15);
  }
  return m;
}
#else
template <int run> NOETHER_EIGHT_INLINE EightMerged merged(const Eight& a, const Eight& b) {
  EightMerged m;
  for (int k = 0; k < eight_registers; ++k) {
    if constexpr (run < eight_width) {
#if NOETHER_EIGHT_REGISTERS == 2
      m.even.r[k] =
          EightRegister(run == 1 ? _mm256_unpacklo_pd(a.r[k], b.r[k]) : _mm256_permute2f128_pd(a.r[k], b.r[k], 0x20));
      m.odd.r[k] =
          EightRegister(run == 1 ? _mm256_unpackhi_pd(a.r[k], b.r[k]) : _mm256_permute2f128_pd(a.r[k], b.r[k], 0x31));
#else
      m.even.r[k] = __builtin_shufflevector(a.r[k], b.r[k], 0, 2);
      m.odd.r[k] = __builtin_shufflevector(a.r[k], b.r[k], 1, 3);
#endif
    } else {
      constexpr int registers = run / eight_width;  // of a run
      const Eight& from = k / registers % 2 == 0 ? a : b;
      const int first = k / (2 * registers) * 2 * registers + k % registers;
      m.even.r[k] = from.r[first];
      m.odd.r[k] = from.r[first + registers];
    }
  }
  return m;
}
#endif

/// All lanes of eight rows joined, those of row k in lane k, in one order at every level. @param row  gives row k
template <class Row, class Join, int rows = 8>
NOETHER_EIGHT_INLINE Eight joined_lanes(const Row& row, const Join& join, int first = 0) {
  if constexpr (rows == 1) {
    return row(first);
  } else {
    const auto half = [&](int from) { return joined_lanes<Row, Join, rows / 2>(row, join, from); };
    const EightMerged m = merged<rows / 2>(half(first), half(first + rows / 2));
    return join(m.even, m.odd);
  }
}
template <class Row> NOETHER_EIGHT_INLINE Eight sums_of_lanes(const Row& row) {
  return joined_lanes(row, [](const Eight& a, const Eight& b) { return a + b; });
}
/// The same sums in two words.
template <int rows = 8> NOETHER_EIGHT_INLINE EightWide sums_of_lanes(const EightWide (&row)[8], int first = 0) {
  if constexpr (rows == 1) {
    return row[first];
  } else {
    const EightWide a = sums_of_lanes<rows / 2>(row, first), b = sums_of_lanes<rows / 2>(row, first + rows / 2);
    const EightMerged high = merged<rows / 2>(a.high, b.high), low = merged<rows / 2>(a.low, b.low);
    return EightWide{high.even, low.even} + EightWide{high.odd, low.odd};
  }
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

#include "numbers/noise_simd.hpp"

#include <hwy/highway.h>

#include <cmath>

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

#if HWY_TARGET == HWY_SCALAR

constexpr NoiseKernels kernels{nullptr, 1};

#else

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, 8>;
using Words = hn::Rebind<std::uint64_t, Lanes>;
using Halves = hn::Repartition<std::uint32_t, Words>;
using Vector = hn::Vec<Lanes>;
using Bits = hn::Vec<Words>;
constexpr std::ptrdiff_t lanes = hn::MaxLanes(Lanes());

/// 128 bits in each lane: four words of 32, each in the lower half of one of 64.
struct Counter {
  Bits word[4];
};

HWY_INLINE Bits word(std::uint64_t x) { return hn::Set(Words(), x); }
HWY_INLINE Vector number(double x) { return hn::Set(Lanes(), x); }

/// `philox` of numbers/random.hpp. What stands in the upper halves in between, products do not see.
HWY_INLINE Counter philox(Counter c, const std::uint32_t (&key)[2]) {
  const auto product = [](Bits x, std::uint32_t factor) {
    return hn::MulEven(hn::BitCast(Halves(), x), hn::BitCast(Halves(), word(factor)));
  };
  std::uint32_t k0 = key[0], k1 = key[1];
  for (int round = 0; round < 10; ++round, k0 += 0x9E3779B9U, k1 += 0xBB67AE85U) {
    const Bits a = product(c.word[0], 0xD2511F53U), b = product(c.word[2], 0xCD9E8D57U);
    c = {{hn::Xor(hn::Xor(hn::ShiftRight<32>(b), c.word[1]), word(k0)), b,
          hn::Xor(hn::Xor(hn::ShiftRight<32>(a), c.word[3]), word(k1)), a}};
  }
  for (Bits& one : c.word) one = hn::And(one, word(0xFFFFFFFFU));
  return c;
}

/// A whole number below 2^52.
HWY_INLINE Vector whole(Bits x) {
  return hn::Sub(hn::BitCast(Lanes(), hn::Or(x, word(0x4330000000000000U))), number(0x1p52));
}

/// `open_uniform`, `log_by_series` and `turn_by_series` of numbers/random.hpp, operation by operation.
HWY_INLINE Vector open_uniform(Bits low, Bits high) {
  const Bits bits = hn::ShiftRight<12>(hn::Or(hn::ShiftLeft<32>(high), low));
  return hn::Mul(hn::Add(whole(bits), number(0.5)), number(0x1p-52));
}

HWY_INLINE Vector log_by_series(Vector u) {
  const Bits bits = hn::BitCast(Words(), u);
  Vector exponent = hn::Sub(whole(hn::ShiftRight<52>(bits)), number(1023));
  Vector m = hn::BitCast(Lanes(), hn::Or(hn::And(bits, word(0xFFFFFFFFFFFFFU)), word(0x3FF0000000000000U)));
  const auto large = hn::Gt(m, number(0x1.6a09e667f3bcdp0));  // the root of 2
  m = hn::IfThenElse(large, hn::Mul(m, number(0.5)), m);
  exponent = hn::IfThenElse(large, hn::Add(exponent, number(1)), exponent);
  const Vector s = hn::Div(hn::Sub(m, number(1)), hn::Add(m, number(1))), s2 = hn::Mul(s, s);
  Vector sum = number(0);
  for (int k = 21; k >= 1; k -= 2) sum = hn::Add(hn::Mul(sum, s2), number(1.0 / k));
  return hn::Add(hn::Mul(exponent, number(0x1.62e42fefa39efp-1)), hn::Mul(hn::Mul(number(2), s), sum));
}

struct Turn {
  Vector cosine, sine;
};

/// a / n as it is rounded, for a whole number n below 2^10: a quotient is so far from the middle of two doubles that
/// one correction of a product finds it, in a fraction of the time of a division.
HWY_INLINE Vector quotient(Vector a, int n) {
#if HWY_NATIVE_FMA
  const Vector inverse = number(1.0 / n), product = hn::Mul(a, inverse);
  return hn::MulAdd(hn::NegMulAdd(product, number(n), a), inverse, product);
#else
  return hn::Div(a, number(n));
#endif
}

HWY_INLINE Turn turn_by_series(Vector u) {
  const Vector quarter = hn::Floor(hn::Add(hn::Mul(number(4), u), number(0.5)));
  const Vector angle = hn::Mul(number(2 * 0x1.921fb54442d18p1), hn::Sub(u, hn::Mul(number(0.25), quarter)));
  const Vector a2 = hn::Mul(angle, angle), one = number(1);
  Vector cosine = one, sine = one;
  for (int k = 18; k >= 2; k -= 2) {
    cosine = hn::Sub(one, hn::Mul(cosine, quotient(a2, k * (k - 1))));
    sine = hn::Sub(one, hn::Mul(sine, quotient(a2, k * (k + 1))));
  }
  sine = hn::Mul(sine, angle);
  const auto first = hn::Eq(quarter, number(1)), second = hn::Eq(quarter, number(2)),
             third = hn::Eq(quarter, number(3));
  const auto swapped = hn::Or(first, third);
  const Vector x = hn::IfThenElse(swapped, sine, cosine), y = hn::IfThenElse(swapped, cosine, sine);
  return {hn::IfThenElse(hn::Or(first, second), hn::Neg(x), x), hn::IfThenElse(hn::Or(second, third), hn::Neg(y), y)};
}

struct Pair {
  Vector first, second;
};

/// `normal_pair` of numbers/random.hpp.
HWY_INLINE Pair normal_pair(const Counter& bits) {
  const Vector radius = hn::Sqrt(hn::Mul(number(-2), log_by_series(open_uniform(bits.word[0], bits.word[1]))));
  const Turn turn = turn_by_series(open_uniform(bits.word[2], bits.word[3]));
  return {hn::Mul(radius, turn.cosine), hn::Mul(radius, turn.sine)};
}

void normals(const std::uint32_t (&key)[2], const std::int64_t* ids, std::ptrdiff_t count, std::int64_t step,
             std::uint32_t stage, double* x, double* y, double* z) {
  const Lanes d;
  const auto when = static_cast<std::uint64_t>(step);
  for (std::ptrdiff_t i = 0; i < count; i += lanes) {
    const Bits who = hn::BitCast(Words(), hn::LoadU(hn::Rebind<std::int64_t, Lanes>(), ids + i));
    Counter counter = {{hn::And(who, word(0xFFFFFFFFU)),
                        hn::Or(hn::ShiftRight<32>(who), word(std::uint64_t{stage} << 22U)), word(when & 0xFFFFFFFFU),
                        word(when >> 32U)}};
    const Pair one = normal_pair(philox(counter, key));
    counter.word[1] = hn::Or(counter.word[1], word(1U << 29U));
    const Pair other = normal_pair(philox(counter, key));
    hn::StoreU(one.first, d, x + i);
    hn::StoreU(one.second, d, y + i);
    hn::StoreU(other.first, d, z + i);
  }
}

constexpr NoiseKernels kernels{normals, lanes};

#endif

}  // namespace

extern const NoiseKernels noise_kernels;
constinit const NoiseKernels noise_kernels = kernels;

}  // namespace noether::NOETHER_SIMD_LEVEL

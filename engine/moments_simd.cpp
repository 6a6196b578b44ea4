#include "engine/moments_simd.hpp"

#include <hwy/highway.h>

#include <cstdint>
#include <cstring>

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

/// How many grids numbers are cut to.
constexpr int grids = 3;

/// A sum of numbers that are cut to multiples of grids, each finer than the one before: all additions are exact.
struct Sum {
  Vector parts[grids];

  /// @param anchors  1.5 2^52 times each grid, which round to it what is added to them
  HWY_INLINE void add(Vector x, const Vector (&anchors)[grids]) {
    for (int k = 0; k < grids; ++k) {
      const Vector part = hn::Sub(hn::Add(x, anchors[k]), anchors[k]);
      parts[k] = hn::Add(parts[k], part);
      if (k + 1 < grids) x = hn::Sub(x, part);
    }
  }
};

/// Products of one register of particles: `count` along each axis.
template <int count> struct Products { Wide of[3][count]; };

/// The exponent that infinities have, and what is no number.
constexpr std::uint64_t not_finite = 0x7FF;

std::uint64_t exponent_of(double size) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &size, sizeof bits);
  return bits >> 52U;
}

double power_of_two(std::int64_t exponent) {
  const std::uint64_t bits = static_cast<std::uint64_t>(exponent + 1023) << 52U;
  double power = 0;
  std::memcpy(&power, &bits, sizeof power);
  return power;
}

/// The exponent of numbers that have been made smaller by 2^down.
std::uint64_t lowered(std::uint64_t exponent, std::uint64_t down) {
  if (exponent == not_finite) return exponent;
  return exponent > down ? exponent - down : 0;
}

/// Grids for 2^room numbers below twice a power of two: where all of them are multiples of a grid, their sum has 53
/// bits.
/// @param exponent  of the largest number, biased; of what is not finite all sums are no numbers
HWY_INLINE void set_anchors(std::uint64_t exponent, std::uint64_t room, Vector (&anchors)[grids]) {
  std::int64_t at = static_cast<std::int64_t>(exponent + room);
  for (int k = 0; k < grids; ++k) {
    const std::uint64_t held = exponent == not_finite ? not_finite : at < 1 ? 1 : static_cast<std::uint64_t>(at);
    const std::uint64_t bits = (held << 52U) | (std::uint64_t{1} << 51U);
    double anchor = 0;
    std::memcpy(&anchor, &bits, sizeof anchor);
    anchors[k] = hn::Set(Lanes(), anchor);
    at -= 54 - static_cast<std::int64_t>(room);
  }
}

/// The sum of all parts, as high + low.
HWY_INLINE void store_total(const Sum& sum, double back, double& high, double& low) {
  double part[grids];
  for (int k = 0; k < grids; ++k) part[k] = hn::GetLane(hn::SumOfLanes(Lanes(), sum.parts[k]));
  const auto add = [](double a, double b, double& lost) {
    const double s = a + b, of_b = s - a;
    lost = (a - (s - of_b)) + (b - of_b);
    return s;
  };
  double lost = 0, lost_before = 0;
  const double fine = add(part[1], part[2], lost_before);
  high = back * add(part[0], fine, lost);
  low = back * (lost + lost_before);
}

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

/// Calls `body(load)` for every register of particles, where `load` reads a column.
template <class Body> HWY_INLINE void for_registers(std::ptrdiff_t count, const Body& body) {
  const Lanes d;
  const std::ptrdiff_t some = count % lanes;
  if (some > 0) body([&](const double* column) HWY_ATTR { return load_some(column, some); });
  for (std::ptrdiff_t i = some; i < count; i += lanes) {
    body([&](const double* column) HWY_ATTR { return hn::LoadU(d, column + i); });
  }
}

/// Sums what `products(load, scale)` gives for every register of particles: looks for the largest first, so that the
/// grids do not depend on any order.
template <int terms, class Of> HWY_INLINE void sum_registers(std::ptrdiff_t count, const Of& products, WideSums& sums) {
  const Lanes d;
  Vector largest[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for_registers(count, [&](const auto& load) HWY_ATTR {
    const Products<terms> all = products(load, hn::Set(d, 1.0));
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < terms; ++j) largest[k] = hn::Max(largest[k], hn::Abs(all.of[k][j].high));
    }
  });
  std::uint64_t exponents[3], room = 2, highest = 0;
  while ((std::int64_t{1} << room) < 2 * terms * count) ++room;
  for (int k = 0; k < 3; ++k) {
    exponents[k] = exponent_of(hn::GetLane(hn::MaxOfLanes(d, largest[k])));
    highest = exponents[k] > highest ? exponents[k] : highest;
  }
  // Anchors are above what they round: where that would leave the doubles, masses count less.
  const std::uint64_t down = highest > 1850 && highest < not_finite ? 256 : 0;
  Vector anchors[3][grids];
  for (int k = 0; k < 3; ++k) set_anchors(lowered(exponents[k], down), room, anchors[k]);
  Sum all[3];
  for (Sum& sum : all) {
    for (Vector& part : sum.parts) part = hn::Zero(d);
  }
  const Vector scale = hn::Set(d, power_of_two(-static_cast<std::int64_t>(down)));
  for_registers(count, [&](const auto& load) HWY_ATTR {
    const Products<terms> some = products(load, scale);
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < terms; ++j) {
        all[k].add(some.of[k][j].high, anchors[k]);
        all[k].add(some.of[k][j].low, anchors[k]);
      }
    }
  });
  const double back = power_of_two(static_cast<std::int64_t>(down));
  for (int k = 0; k < 3; ++k) store_total(all[k], back, sums.high[k], sums.low[k]);
}

void weighted(const WeightedVectors& vectors, WideSums& sums) {
  const auto products = [&](const auto& load, Vector scale) HWY_ATTR {
    const Vector m = hn::Mul(scale, load(vectors.mass));
    Products<1> all;
    for (int k = 0; k < 3; ++k) all.of[k][0] = product(m, load(vectors.x[k]));
    return all;
  };
  sum_registers<1>(vectors.count, products, sums);
}

void crossed(const WeightedVectors& velocities, const double* const (&x)[3], WideSums& sums) {
  const auto moment = [](Vector distance, const Wide& momentum) HWY_ATTR {
    const Wide q = product(distance, momentum.high);
    return Wide{q.high, hn::Add(q.low, hn::Mul(distance, momentum.low))};
  };
  const auto products = [&](const auto& load, Vector scale) HWY_ATTR {
    const Vector m = hn::Mul(scale, load(velocities.mass));
    Vector at[3];
    Wide p[3];
    for (int k = 0; k < 3; ++k) {
      at[k] = load(x[k]);
      p[k] = product(m, load(velocities.x[k]));
    }
    Products<2> all;
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      all.of[k][0] = moment(at[a], p[b]);
      all.of[k][1] = moment(hn::Neg(at[b]), p[a]);
    }
    return all;
  };
  sum_registers<2>(velocities.count, products, sums);
}

}  // namespace

extern const MomentKernels moment_kernels;
constinit const MomentKernels moment_kernels{weighted, crossed};

}  // namespace noether::NOETHER_SIMD_LEVEL

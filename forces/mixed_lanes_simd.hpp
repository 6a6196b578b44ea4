#pragma once
/// Eight particles and their neighbors in lanes of single precision: places in whole numbers, and sums in whole units.
/// For `*_simd.cpp` alone.

#include "forces/pair_row.hpp"

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, 16>;
using Whole = hn::Rebind<std::int32_t, Lanes>;
using Vector = hn::Vec<Lanes>;
using WholeVector = hn::Vec<Whole>;
constexpr std::ptrdiff_t lanes = hn::MaxLanes(Lanes());
constexpr std::ptrdiff_t group_size = 8;
/// Rows of neighbors that go through the lanes together, and how much of a row does.
constexpr std::ptrdiff_t rows_at_once = lanes > group_size ? lanes / group_size : 1;
constexpr std::ptrdiff_t lanes_of_group = lanes > group_size ? group_size : lanes;

/// Lists are longer than caches: entries are asked for as many rows before their turn.
constexpr std::ptrdiff_t rows_asked_ahead = 128;

/// x, y, z and the fourth numbers of as many records as there are lanes.
struct Points {
  WholeVector x, y, z, fourth;
};

#if HWY_TARGET == HWY_SCALAR

/// @param record  of a lane
template <class Record> HWY_INLINE Points load_points(const Record& record) {
  const std::int32_t* one = record(0);
  return {hn::Set(Whole(), one[0]), hn::Set(Whole(), one[1]), hn::Set(Whole(), one[2]), hn::Set(Whole(), one[3])};
}

#else

/// Records first, first + 4, ... side by side.
template <class D, class Record> HWY_INLINE hn::Vec<D> every_fourth(D d, const Record& record, int first) {
#if HWY_TARGET <= HWY_AVX3
  const auto load = [&](int k)
                        HWY_ATTR { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(record(first + k))); };
  if constexpr (hn::MaxLanes(D()) == 16) {  // inserting would take the ports of the turning below
    __m512i all = _mm512_castsi128_si512(load(0));
    all = _mm512_mask_broadcast_i32x4(all, 0x00f0, load(4));
    all = _mm512_mask_broadcast_i32x4(all, 0x0f00, load(8));
    return hn::Vec<D>{_mm512_mask_broadcast_i32x4(all, 0xf000, load(12))};
  }
#endif
  if constexpr (hn::MaxLanes(D()) > 4) {
    const hn::Half<D> half;
    return hn::Combine(d, every_fourth(half, record, first + static_cast<int>(hn::MaxLanes(half))),
                       every_fourth(half, record, first));
  } else {
    return hn::LoadU(d, record(first));
  }
}

/// Records are loaded whole, 16 bytes each, and turned. What nobody asks for is not made.
/// @param record  of a lane
template <class Record> HWY_INLINE Points load_points(const Record& record) {
  const Whole i;
  const hn::Repartition<std::int64_t, Whole> pairs;
  const auto a = every_fourth(i, record, 0), b = every_fourth(i, record, 1), c = every_fourth(i, record, 2),
             e = every_fourth(i, record, 3);
  const auto xy_low = hn::BitCast(pairs, hn::InterleaveLower(i, a, b)),
             xy_high = hn::BitCast(pairs, hn::InterleaveLower(i, c, e)),
             z_low = hn::BitCast(pairs, hn::InterleaveUpper(i, a, b)),
             z_high = hn::BitCast(pairs, hn::InterleaveUpper(i, c, e));
  return {hn::BitCast(i, hn::InterleaveLower(pairs, xy_low, xy_high)),
          hn::BitCast(i, hn::InterleaveUpper(pairs, xy_low, xy_high)),
          hn::BitCast(i, hn::InterleaveLower(pairs, z_low, z_high)),
          hn::BitCast(i, hn::InterleaveUpper(pairs, z_low, z_high))};
}

#endif

HWY_INLINE Points load_points(const std::int32_t* records, const std::int32_t* offsets) {
  return load_points([&](int k) HWY_ATTR { return records + static_cast<std::ptrdiff_t>(offsets[k]); });
}

/// From the particles in the lanes to their neighbors.
struct Distances {
  Vector dx, dy, dz, r2;
};

HWY_INLINE Distances distances(const Points& own, const Points& other) {
  const Lanes d;
  const Vector dx = hn::ConvertTo(d, hn::Sub(own.x, other.x)), dy = hn::ConvertTo(d, hn::Sub(own.y, other.y)),
               dz = hn::ConvertTo(d, hn::Sub(own.z, other.z));
  return {dx, dy, dz, hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)))};
}

/// The nearest whole numbers, of numbers below 2^31: hn::NearestInt asks for larger ones too, in four instructions.
HWY_INLINE WholeVector nearest_whole(Vector x) {
#if HWY_TARGET <= HWY_AVX3
  return WholeVector{_mm512_cvtps_epi32(x.raw)};
#elif HWY_TARGET == HWY_AVX2
  return WholeVector{_mm256_cvtps_epi32(x.raw)};
#elif HWY_TARGET == HWY_SCALAR
  const double shifted = static_cast<double>(hn::GetLane(x)) + 6755399441055744.0;  // 1.5 x 2^52
  std::int64_t bits = 0;
  __builtin_memcpy(&bits, &shifted, sizeof bits);
  return hn::Set(Whole(), static_cast<std::int32_t>(bits));
#else
  return hn::NearestInt(x);
#endif
}

/// A sum of products below 2^28, each rounded to a whole number.
struct QuickSum {
  static constexpr std::ptrdiff_t most = 7;  ///< products that a lane of 32 bits has room for

#if HWY_TARGET == HWY_SCALAR
  std::int64_t sum = 0;

  HWY_INLINE void add(Vector a, Vector b) { sum += hn::GetLane(nearest_whole(hn::Mul(a, b))); }
  HWY_INLINE void widen() {}
  HWY_INLINE void store(std::int64_t* out) const { out[0] = sum; }
#else
  using HalfWhole = hn::Half<Whole>;
  using Wide = hn::Rebind<std::int64_t, HalfWhole>;
  WholeVector recent = hn::Zero(Whole());
  hn::Vec<Wide> lower = hn::Zero(Wide()), upper = hn::Zero(Wide());

  HWY_INLINE void add(Vector a, Vector b) { recent = hn::Add(recent, nearest_whole(hn::Mul(a, b))); }
  HWY_INLINE void widen() {
    const Wide wide;
    const HalfWhole half;
    lower = hn::Add(lower, hn::PromoteTo(wide, hn::LowerHalf(half, recent)));
    upper = hn::Add(upper, hn::PromoteTo(wide, hn::UpperHalf(half, recent)));
    recent = hn::Zero(Whole());
  }
  HWY_INLINE void store(std::int64_t* out) const {
    const Wide wide;
    if constexpr (rows_at_once > 1) {
      hn::StoreU(hn::Add(lower, upper), wide, out);
    } else {
      hn::StoreU(lower, wide, out);
      hn::StoreU(upper, wide, out + lanes / 2);
    }
  }
#endif
};

/// The same sum for products up to 2^35; a stronger one is noted, and only its direction counts.
struct CarefulSum {
  static constexpr std::ptrdiff_t most = 7;
  static constexpr std::int64_t strongest = std::int64_t{1} << 31U;

  std::int64_t sum[lanes_of_group] = {};
  bool strong[lanes_of_group] = {};

  void add(Vector a, Vector b) {
    float product[lanes];
    hn::StoreU(hn::Mul(a, b), Lanes(), product);
    for (std::ptrdiff_t k = 0; k < lanes; ++k) {
      const bool weak = product[k] < 0x1p35F && product[k] > -0x1p35F;
      strong[k % lanes_of_group] = strong[k % lanes_of_group] || !weak;
      sum[k % lanes_of_group] += weak             ? __builtin_llrintf(product[k])
                                 : product[k] > 0 ? strongest
                                 : product[k] < 0 ? -strongest
                                                  : 0;
    }
  }
  void widen() {}
  void store(std::int64_t* out) const {
    for (std::ptrdiff_t k = 0; k < lanes_of_group; ++k) out[k] = sum[k];
  }
};

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL

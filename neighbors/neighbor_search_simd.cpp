#include "neighbors/neighbor_search_simd.hpp"

#include <hwy/highway.h>

#include <cstdint>

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Numbers = hn::Rebind<std::int32_t, Floats>;
constexpr std::ptrdiff_t lanes = hn::MaxLanes(Floats());
constexpr float far_away = 3e18F;  // its square is a number

#if HWY_TARGET == HWY_AVX2

/// [mask]: the lanes in the mask, a byte each.
struct LanesOfMasks {
  std::uint64_t of[256] = {};
  constexpr LanesOfMasks() {
    for (std::uint64_t mask = 0; mask < 256; ++mask) {
      std::uint64_t found = 0;
      for (std::uint64_t lane = 0; lane < 8; ++lane) {
        if ((mask >> lane & 1U) != 0) of[mask] |= lane << (8 * found++);
      }
    }
  }
};
constexpr LanesOfMasks lanes_of_masks;

/// Moves lanes of a mask to the front. (What Highway 1.0 does here, g++ makes a copy of a table of 1 KiB each time.)
class Front {
 public:
  explicit HWY_INLINE Front(hn::Mask<Numbers> wanted) {
    const auto bits =
        static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(hn::VecFromMask(Numbers(), wanted).raw)));
    count_ = __builtin_popcount(bits);
    lanes_ = {_mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<std::int64_t>(lanes_of_masks.of[bits])))};
  }
  std::ptrdiff_t count() const { return count_; }
  HWY_INLINE hn::Vec<Numbers> operator()(hn::Vec<Numbers> v) const {
    return hn::TableLookupLanes(v, hn::IndicesFromVec(Numbers(), lanes_));
  }
  HWY_INLINE hn::Vec<Floats> operator()(hn::Vec<Floats> v) const {
    return hn::TableLookupLanes(v, hn::IndicesFromVec(Floats(), lanes_));
  }

 private:
  std::ptrdiff_t count_;
  hn::Vec<Numbers> lanes_;
};

#else

/// Moves lanes of a mask to the front.
class Front {
 public:
  explicit HWY_INLINE Front(hn::Mask<Numbers> wanted) : wanted_(wanted) {}
  HWY_INLINE std::ptrdiff_t count() const { return static_cast<std::ptrdiff_t>(hn::CountTrue(Numbers(), wanted_)); }
  HWY_INLINE hn::Vec<Numbers> operator()(hn::Vec<Numbers> v) const { return hn::Compress(v, wanted_); }
  HWY_INLINE hn::Vec<Floats> operator()(hn::Vec<Floats> v) const {
    return hn::Compress(v, hn::RebindMask(Floats(), wanted_));
  }

 private:
  hn::Mask<Numbers> wanted_;
};

#endif

/// Coordinates relative to the middle; the squares of their distances from the box along one axis are added to `r2`.
HWY_INLINE hn::Vec<Floats> relative(const float* x, float middle, float half, hn::Vec<Floats>& r2) {
  const Floats d;
  const auto at = hn::Sub(hn::LoadU(d, x), hn::Set(d, middle));
  const auto outside = hn::ZeroIfNegative(hn::Sub(hn::Abs(at), hn::Set(d, half)));
  r2 = hn::MulAdd(outside, outside, r2);
  return at;
}

void gather(const PointRun* runs, std::ptrdiff_t count, const SearchPoints& points, const SearchBox& box, float limit,
            NearPoints& near) {
  const Floats d;
  const Numbers i;
  const auto first = hn::Iota(i, 0);
  const auto most = hn::Set(d, limit);
  float *const near_x = near.x, *const near_y = near.y, *const near_z = near.z;
  std::int32_t* const near_number = near.number;
  std::ptrdiff_t found = 0;
  for (const PointRun* run = runs; run < runs + count; ++run) {
    const float *x = points.x + run->begin, *y = points.y + run->begin, *z = points.z + run->begin;
    for (std::int32_t k = 0; k < run->count; k += lanes) {
      auto r2 = hn::Zero(d);
      const auto px = relative(x + k, box.middle[0], box.half[0], r2);
      const auto py = relative(y + k, box.middle[1], box.half[1], r2);
      const auto pz = relative(z + k, box.middle[2], box.half[2], r2);
      const auto there = hn::Lt(first, hn::Set(i, run->count - k));
      const Front front(hn::And(hn::RebindMask(i, hn::Le(r2, most)), there));
      const auto number = hn::Add(first, hn::Set(i, run->number + k));
      hn::StoreU(front(px), d, near_x + found);
      hn::StoreU(front(py), d, near_y + found);
      hn::StoreU(front(pz), d, near_z + found);
      hn::StoreU(front(number), i, near_number + found);
      found += front.count();
    }
  }
  hn::StoreU(hn::Set(d, far_away), d, near_x + found);
  near.count = found;
}

std::ptrdiff_t select(const NearPoints& near, float x, float y, float z, float limit, std::int32_t* number,
                      float* distance) {
  const Floats d;
  const Numbers i;
  const auto x0 = hn::Set(d, x), y0 = hn::Set(d, y), z0 = hn::Set(d, z), most = hn::Set(d, limit);
  std::ptrdiff_t found = 0;
  for (std::ptrdiff_t k = 0; k < near.count; k += lanes) {
    const auto dx = hn::Sub(hn::LoadU(d, near.x + k), x0);
    const auto dy = hn::Sub(hn::LoadU(d, near.y + k), y0);
    const auto dz = hn::Sub(hn::LoadU(d, near.z + k), z0);
    const auto r2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    const Front front(hn::RebindMask(i, hn::Le(r2, most)));
    hn::StoreU(front(hn::LoadU(i, near.number + k)), i, number + found);
    hn::StoreU(front(r2), d, distance + found);
    found += front.count();
  }
  return found;
}

std::ptrdiff_t sort(const std::int32_t* number, float* r2, std::ptrdiff_t count, const std::int32_t* struck,
                    std::ptrdiff_t struck_count, const float (&limits)[neighbor_shells], std::int32_t* out,
                    std::int32_t (&rows)[neighbor_shells]) {
  const Floats d;
  const Numbers i;
  const auto first = hn::Iota(i, 0);
  const auto nowhere = hn::Set(d, far_away);
  for (std::ptrdiff_t k = 0; k < count; k += lanes) {
    const auto numbers = hn::LoadU(i, number + k);
    auto out_of_it = hn::Gt(first, hn::Set(i, static_cast<std::int32_t>(count - k - 1)));
    for (std::ptrdiff_t s = 0; s < struck_count; ++s) {
      out_of_it = hn::Or(out_of_it, hn::Eq(numbers, hn::Set(i, struck[s])));
    }
    hn::StoreU(hn::IfThenElse(hn::RebindMask(d, out_of_it), nowhere, hn::LoadU(d, r2 + k)), d, r2 + k);
  }
  auto inner = hn::Set(d, -1.0F);
  std::int32_t* to = out;
  for (int shell = 0; shell < neighbor_shells; ++shell) {
    const auto outer = hn::Set(d, limits[shell]);
    for (std::ptrdiff_t k = 0; k < count; k += lanes) {
      const auto distance = hn::LoadU(d, r2 + k);
      const Front front(hn::RebindMask(i, hn::And(hn::Gt(distance, inner), hn::Le(distance, outer))));
      hn::StoreU(front(hn::LoadU(i, number + k)), i, to);
      to += front.count();
    }
    const auto within = static_cast<std::int32_t>(to - out);
    rows[shell] = rows[shell] > within ? rows[shell] : within;
    inner = outer;
  }
  return to - out;
}

void turn(const std::int32_t* const (&lists)[8], std::ptrdiff_t rows, std::int32_t* out) {
  for (std::ptrdiff_t row = 0; row < rows; row += 8) {
    std::int32_t* to = out + 8 * row;
#if HWY_MAX_BYTES < 32
    for (int lane = 0; lane < 8; ++lane) {
      for (int k = 0; k < 8; ++k) to[8 * k + lane] = 4 * lists[lane][row + k];
    }
#else
    const hn::CappedTag<std::int32_t, 8> d;
    const hn::Repartition<std::int64_t, decltype(d)> wide;
    const auto load = [&](int lane) { return hn::ShiftLeft<2>(hn::LoadU(d, lists[lane] + row)); };
    const auto wide_low = [&](auto a, auto b) {
      return hn::BitCast(d, hn::InterleaveLower(wide, hn::BitCast(wide, a), hn::BitCast(wide, b)));
    };
    const auto wide_high = [&](auto a, auto b) {
      return hn::BitCast(d, hn::InterleaveUpper(wide, hn::BitCast(wide, a), hn::BitCast(wide, b)));
    };
    hn::Vec<decltype(d)> four[2][4];  // rows k and k + 4 of four lists
    for (int half = 0; half < 2; ++half) {
      const auto a = load(4 * half), b = load(4 * half + 1), c = load(4 * half + 2), e = load(4 * half + 3);
      const auto ab = hn::InterleaveLower(d, a, b), ce = hn::InterleaveLower(d, c, e);
      const auto ab_high = hn::InterleaveUpper(d, a, b), ce_high = hn::InterleaveUpper(d, c, e);
      four[half][0] = wide_low(ab, ce);
      four[half][1] = wide_high(ab, ce);
      four[half][2] = wide_low(ab_high, ce_high);
      four[half][3] = wide_high(ab_high, ce_high);
    }
    for (int k = 0; k < 4; ++k) {
      hn::StoreU(hn::ConcatLowerLower(d, four[1][k], four[0][k]), d, to + 8 * k);
      hn::StoreU(hn::ConcatUpperUpper(d, four[1][k], four[0][k]), d, to + 8 * (k + 4));
    }
#endif
  }
}

}  // namespace

extern const NeighborSearchKernels neighbor_search_kernels;
const NeighborSearchKernels neighbor_search_kernels{gather, select, sort, turn};

}  // namespace noether::NOETHER_SIMD_LEVEL

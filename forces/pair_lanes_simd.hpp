#pragma once
/// Eight particles and their neighbors in lanes of doubles: loading pairs, and summing what they do in whole units. For
/// `*_simd.cpp` alone.

#include "forces/minimum_simd.hpp"
#include "forces/pair_row.hpp"

#include <hwy/highway.h>

#include <cmath>
#include <cstdint>

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, 8>;
using Whole = hn::Rebind<std::int64_t, Lanes>;
using Vector = hn::Vec<Lanes>;
using WholeVector = hn::Vec<Whole>;
constexpr std::ptrdiff_t lanes = hn::MaxLanes(Lanes());

/// x, y and z of as many records as there are lanes.
struct Points {
  Vector x, y, z;
};

/// The same with the fourth numbers: types or charges.
struct Records {
  Points place;
  Vector fourth;
};

/// Records are loaded whole, 32 bytes each, or in halves, which four lanes need fewer shuffles for, and turned: gathers
/// of single numbers take longer. What nobody asks for is not made.
/// @param record  of a lane
template <class Record> HWY_INLINE Records load_records(const Record& record) {
  const Lanes d;
#if HWY_TARGET == HWY_SCALAR
  const double* one = record(0);
  return {{hn::Set(d, one[0]), hn::Set(d, one[1]), hn::Set(d, one[2])}, hn::Set(d, one[3])};
#elif HWY_MAX_BYTES == 16
  const double *one = record(0), *two = record(1);
  const Vector a = hn::LoadU(d, one), b = hn::LoadU(d, two), c = hn::LoadU(d, one + 2), e = hn::LoadU(d, two + 2);
  return {{hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b), hn::InterleaveLower(d, c, e)},
          hn::InterleaveUpper(d, c, e)};
#elif HWY_MAX_BYTES >= 64
  const auto two = [&](int k) {  // records k and k + 2
    return _mm512_mask_broadcast_f64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(record(k))), 0xf0,
                                       _mm256_loadu_pd(record(k + 2)));
  };
  const __m512d a = two(0), b = two(1), c = two(4), e = two(5);
  const __m512d xz_low = _mm512_unpacklo_pd(a, b), xz_high = _mm512_unpacklo_pd(c, e);
  const __m512d yq_low = _mm512_unpackhi_pd(a, b), yq_high = _mm512_unpackhi_pd(c, e);
  static_cast<void>(d);
  return {{Vector{_mm512_shuffle_f64x2(xz_low, xz_high, 0x88)}, Vector{_mm512_shuffle_f64x2(yq_low, yq_high, 0x88)},
           Vector{_mm512_shuffle_f64x2(xz_low, xz_high, 0xdd)}},
          Vector{_mm512_shuffle_f64x2(yq_low, yq_high, 0xdd)}};
#else
  const auto two = [&](int k, int from) {  // of records k and k + 2
    return Vector{_mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(record(k) + from)),
                                       _mm_loadu_pd(record(k + 2) + from), 1)};
  };
  const Vector a = two(0, 0), b = two(1, 0), c = two(0, 2), e = two(1, 2);
  return {{hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b), hn::InterleaveLower(d, c, e)},
          hn::InterleaveUpper(d, c, e)};
#endif
}

HWY_INLINE Records load_records(const double* records, const std::int32_t* offsets) {
  return load_records([&](int k) HWY_ATTR { return records + static_cast<std::ptrdiff_t>(offsets[k]); });
}

HWY_INLINE Points load_points(const double* records, const std::int32_t* offsets) {
  return load_records(records, offsets).place;
}

/// From the particles in the lanes to their neighbors.
struct Distances {
  Vector dx, dy, dz, r2;
};

HWY_INLINE Distances distances(const Points& own, const Points& other) {
  const Vector dx = hn::Sub(own.x, other.x), dy = hn::Sub(own.y, other.y), dz = hn::Sub(own.z, other.z);
  return {dx, dy, dz, hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)))};
}

/// Lists are longer than caches: entries are asked for as many rows before their turn, mostly those of later groups.
constexpr std::ptrdiff_t rows_asked_ahead = 128;

/// Times a unit: the last bit of numbers near it is one unit.
constexpr double magic_number = 6755399441055744.0;  // 1.5 x 2^52

/// a + b, which goes round beyond 2^63: sums of what is too strong for them are found by their strength, and done again
/// or refused.
HWY_INLINE std::int64_t sum_around(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

/// A sum in whole units of products, each rounded to a unit: added to `magic`, 1.5 x 2^52 units, the last bit of a
/// double is one unit, and its bits are a whole number. Right for products below 2^51 units.
struct QuickSum {
  WholeVector bits = hn::Zero(Whole());

  HWY_INLINE void add(Vector a, Vector b, Vector magic) {
    bits = hn::Add(bits, hn::BitCast(Whole(), hn::MulAdd(a, b, magic)));
  }
  /// @param added  how many products there were
  HWY_INLINE void store(double magic, std::ptrdiff_t added, std::int64_t* out) const {
    const Whole i;
    const auto offset = hn::BitCast(i, hn::Set(Lanes(), magic));
    std::int64_t one[lanes];
    hn::StoreU(offset, i, one);
    const auto all = static_cast<std::int64_t>(static_cast<std::uint64_t>(one[0]) * static_cast<std::uint64_t>(added));
    hn::StoreU(hn::Sub(bits, hn::Set(i, all)), i, out);
  }
};

/// The same sum for products up to 2^61 units; a stronger one is noted, and only its direction counts. Rows without
/// products of 2^51 units go as those of QuickSum.
struct CarefulSum {
  static constexpr std::int64_t strongest = std::int64_t{1} << 57U;

  WholeVector sum = hn::Zero(Whole());
  bool strong[lanes] = {};  ///< lanes that had a stronger one

  HWY_INLINE void add(Vector a, Vector b, Vector magic) {
    const Vector product = hn::Mul(a, b), unit = hn::Div(magic, hn::Set(Lanes(), magic_number));
    const Vector most = hn::Mul(unit, hn::Set(Lanes(), 0x1.fcp50));
    const auto plain = hn::Lt(hn::Abs(product), most);
    const auto bits = hn::BitCast(Whole(), hn::MulAdd(a, b, magic));
    sum = hn::Add(sum, hn::IfThenElseZero(hn::RebindMask(Whole(), plain), hn::Sub(bits, hn::BitCast(Whole(), magic))));
    if (!hn::AllTrue(Lanes(), plain)) [[unlikely]]
      add_strong(product, magic);
  }
  /// @param added  how many products there were
  HWY_INLINE void store(double /*magic*/, std::ptrdiff_t /*added*/, std::int64_t* out) const {
    hn::StoreU(sum, Whole(), out);
  }

 private:
  /// Those lanes that `add` has left out.
  HWY_NOINLINE void add_strong(Vector products, Vector magic) {
    const Lanes d;
    double product[lanes], offset[lanes];
    std::int64_t all[lanes];
    hn::StoreU(products, d, product);
    hn::StoreU(magic, d, offset);
    hn::StoreU(sum, Whole(), all);
    for (std::ptrdiff_t k = 0; k < lanes; ++k) {
      const double unit = offset[k] / magic_number;
      const double size = product[k] < 0 ? -product[k] : product[k];
      if (size < 0x1.fcp50 * unit) continue;
      if (size < 0x1p61 * unit) {
        all[k] = sum_around(all[k], std::llrint(product[k] / unit));
      } else {
        strong[k] = true;
        all[k] = sum_around(all[k], product[k] > 0 ? strongest : product[k] < 0 ? -strongest : 0);
      }
    }
    sum = hn::LoadU(Whole(), all);
  }
};

/// What their neighbors do to the particles of one register: forces, or energies and virials too.
template <bool everything, class Sum> struct LaneSums {
  double force_zero, energy_zero;  ///< what the sums begin from
  Vector magic, energy_magic;
  Sum force[3], energy, virial[6];

  HWY_INLINE LaneSums(double force_unit, double energy_unit)
      : force_zero(magic_number * force_unit),
        energy_zero(magic_number * energy_unit),
        magic(hn::Set(Lanes(), force_zero)),
        energy_magic(hn::Set(Lanes(), energy_zero)) {}

  /// @param near  a mask: pairs that act @param terms_force  -U'(r) / r
  template <class Mask>
  HWY_INLINE void add(Mask near, Vector terms_energy, Vector terms_force, Vector dx, Vector dy, Vector dz) {
    const Vector k = hn::IfThenElseZero(near, terms_force);
    force[0].add(k, dx, magic);
    force[1].add(k, dy, magic);
    force[2].add(k, dz, magic);
    if constexpr (everything) {
      energy.add(hn::IfThenElseZero(near, terms_energy), hn::Set(Lanes(), 1.0), energy_magic);
      const Vector kx = hn::Mul(k, dx), ky = hn::Mul(k, dy), kz = hn::Mul(k, dz);
      virial[0].add(kx, dx, energy_magic);
      virial[1].add(ky, dy, energy_magic);
      virial[2].add(kz, dz, energy_magic);
      virial[3].add(kx, dy, energy_magic);
      virial[4].add(kx, dz, energy_magic);
      virial[5].add(ky, dz, energy_magic);
    }
  }
  /// Writes the sums of particles `first` and on. @param added  how many pairs each has
  void store(std::ptrdiff_t added, std::ptrdiff_t first, PairSums& out) const {
    for (int k = 0; k < 3; ++k) force[k].store(force_zero, added, out.force[k] + first);
    if constexpr (everything) {
      energy.store(energy_zero, added, out.energy + first);
      for (int k = 0; k < 6; ++k) virial[k].store(energy_zero, added, out.virial[k] + first);
    }
    if constexpr (requires { energy.strong; }) {
      for (std::ptrdiff_t k = 0; k < lanes; ++k) {
        bool strong = energy.strong[k];
        for (const Sum& sum : force) strong = strong || sum.strong[k];
        for (const Sum& sum : virial) strong = strong || sum.strong[k];
        out.strong[first + k] = strong;
      }
    }
  }
};

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL

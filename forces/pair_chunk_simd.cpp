#include "forces/pair_chunk_simd.hpp"

#include "forces/pair_lanes_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

/// The charges of as many records as there are lanes.
HWY_INLINE Vector load_charges(const double* charges, const std::int32_t* offsets) {
  const auto record = hn::ShiftRight<2>(hn::PromoteTo(Whole(), hn::LoadU(hn::Rebind<std::int32_t, Lanes>(), offsets)));
  return hn::GatherIndex(Lanes(), charges, record);
}

void multiply_charges(const PairFilter& filter, const PairGroup& group, std::ptrdiff_t first, PairChunk& chunk) {
  const Lanes d;
  for (std::ptrdiff_t half = 0; half < 8; half += lanes) {
    const Vector own = hn::Mul(hn::Set(d, filter.coulomb_constant), load_charges(filter.charges, group.records + half));
    for (std::ptrdiff_t row = 0; row < chunk.rows; ++row) {
      const Vector other = load_charges(filter.charges, group.entries + 8 * (first + row) + half);
      hn::Store(hn::Mul(own, other), d, chunk.product + 8 * row + half);
    }
  }
}

void load(const PairFilter& filter, const PairGroup& group, std::ptrdiff_t first, PairChunk& chunk) {
  const Lanes d;
  const Vector range2 = hn::Set(d, filter.range2);
  for (std::ptrdiff_t half = 0; half < 8; half += lanes) {
    const Points own = load_points(filter.records, group.records + half);
    for (std::ptrdiff_t row = 0; row < chunk.rows; ++row) {
      const std::int32_t* entries = group.entries + 8 * (first + row) + half;
      __builtin_prefetch(entries + 8 * rows_asked_ahead);
      const Distances pair = distances(own, load_points(filter.records, entries));
      const std::ptrdiff_t to = 8 * row + half;
      hn::Store(pair.dx, d, chunk.dx + to);
      hn::Store(pair.dy, d, chunk.dy + to);
      hn::Store(pair.dz, d, chunk.dz + to);
      hn::Store(lesser(range2, pair.r2), d, chunk.r2 + to);
    }
  }
  if (filter.charges != nullptr) multiply_charges(filter, group, first, chunk);
}

/// Adds whole numbers to those of the rows before.
template <class Numbers> void merge(const Numbers& found, Numbers& sums) {
  for (int k = 0; k < 8; ++k) sums[k] = sum_around(sums[k], found[k]);
}

template <bool everything, class Sum> void add(const PairFilter& filter, const PairChunk& chunk, PairSums& sums) {
  const Lanes d;
  const Vector range2 = hn::Set(d, filter.range2), nearest2 = hn::Set(d, filter.nearest2);
  const Vector limit2 = hn::Set(d, 0x1.8p50 * filter.force_unit * (0x1.8p50 * filter.force_unit));
  PairSums found;
  for (std::ptrdiff_t half = 0; half < 8; half += lanes) {
    LaneSums<everything, Sum> all(filter.force_unit, filter.energy_unit);
    Vector nearest = range2, strength2 = hn::Zero(d);  // a sum, which keeps what is no number
    for (std::ptrdiff_t row = 0; row < chunk.rows; ++row) {
      const std::ptrdiff_t from = 8 * row + half;
      const Vector r2 = hn::Load(d, chunk.r2 + from), force = hn::Load(d, chunk.force + from);
      const auto near = hn::Lt(r2, range2);
      const Vector k = hn::IfThenElseZero(near, force);
      strength2 = hn::Add(strength2, hn::Mul(hn::Mul(k, k), r2));
      nearest = lesser(nearest, r2);
      all.add(near, hn::Load(d, chunk.energy + from), force, hn::Load(d, chunk.dx + from), hn::Load(d, chunk.dy + from),
              hn::Load(d, chunk.dz + from));
    }
    all.store(chunk.rows, half, found);
    const auto weak = hn::And(hn::Le(strength2, limit2), hn::Ge(nearest, nearest2));
    sums.close = sums.close || !hn::AllTrue(d, weak);
    if constexpr (requires { all.energy.strong; }) {
      double least[lanes], strength[lanes];
      hn::StoreU(nearest, d, least);
      hn::StoreU(strength2, d, strength);
      for (std::ptrdiff_t k = 0; k < lanes; ++k) {
        const bool strong = found.strong[half + k] || least[k] < filter.nearest2 || !(strength[k] < 1e300);
        sums.strong[half + k] = sums.strong[half + k] || strong;
      }
    }
  }
  for (int k = 0; k < 3; ++k) merge(found.force[k], sums.force[k]);
  if constexpr (everything) {
    merge(found.energy, sums.energy);
    for (int k = 0; k < 6; ++k) merge(found.virial[k], sums.virial[k]);
  }
}

}  // namespace

extern const PairChunkKernels pair_chunk_kernels;
constinit const PairChunkKernels pair_chunk_kernels{
    load, {{add<false, QuickSum>, add<true, QuickSum>}, {add<false, CarefulSum>, add<true, CarefulSum>}}};

}  // namespace noether::NOETHER_SIMD_LEVEL

#include "forces/pair_chunk_simd.hpp"

#include "forces/pair_lanes_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

bool acts(const PairFilter& filter, std::int32_t own, std::int32_t other) {
  std::int64_t a = 0, b = 0;
  __builtin_memcpy(&a, filter.records + own + 3, sizeof a);
  __builtin_memcpy(&b, filter.records + other + 3, sizeof b);
  return (a == filter.type[0] && b == filter.type[1]) || (a == filter.type[1] && b == filter.type[0]);
}

void load(const PairFilter& filter, const PairGroup& group, std::ptrdiff_t first, PairChunk& chunk) {
  const Lanes d;
  const Vector range2 = hn::Set(d, filter.range2);
  for (std::ptrdiff_t half = 0; half < 8; half += lanes) {
    const Points own = load_points(filter.records, group.records + half);
    for (std::ptrdiff_t row = 0; row < chunk.rows; ++row) {
      const std::int32_t* entries = group.entries + 8 * (first + row) + half;
      __builtin_prefetch(entries + 8 * 128);  // lists are longer than caches
      const Distances pair = distances(own, load_points(filter.records, entries));
      const std::ptrdiff_t to = 8 * row + half;
      hn::Store(pair.dx, d, chunk.dx + to);
      hn::Store(pair.dy, d, chunk.dy + to);
      hn::Store(pair.dz, d, chunk.dz + to);
      hn::Store(lesser(range2, pair.r2), d, chunk.r2 + to);
    }
  }
  if (filter.type[0] < 0) return;
  for (std::ptrdiff_t k = 0; k < 8 * chunk.rows; ++k) {
    if (!acts(filter, group.records[k % 8], group.entries[8 * first + k])) chunk.r2[k] = filter.range2;
  }
}

/// Adds the whole numbers of one register of particles to those of the rows before.
template <class Sum> HWY_INLINE void merge(const Sum& sum, double zero, std::ptrdiff_t added, std::int64_t* out) {
  std::int64_t found[lanes];
  sum.store(zero, added, found);
  for (std::ptrdiff_t k = 0; k < lanes; ++k) out[k] += found[k];
}

template <class Sum> void add(const PairFilter& filter, const PairChunk& chunk, bool all, PairSums& sums) {
  const Lanes d;
  const double force_zero = magic_number * filter.force_unit, energy_zero = magic_number * filter.energy_unit;
  const Vector magic = hn::Set(d, force_zero), energy_magic = hn::Set(d, energy_zero), one = hn::Set(d, 1.0);
  const Vector range2 = hn::Set(d, filter.range2), nearest2 = hn::Set(d, filter.nearest2);
  const Vector limit2 = hn::Set(d, 0x1.8p50 * filter.force_unit * (0x1.8p50 * filter.force_unit));
  for (std::ptrdiff_t half = 0; half < 8; half += lanes) {
    Sum force[3], energy, virial[6];
    Vector nearest = range2, strongest2 = hn::Zero(d);
    for (std::ptrdiff_t row = 0; row < chunk.rows; ++row) {
      const std::ptrdiff_t from = 8 * row + half;
      const Vector r2 = hn::Load(d, chunk.r2 + from);
      const auto near = hn::Lt(r2, range2);
      const Vector k = hn::IfThenElseZero(near, hn::Load(d, chunk.force + from));
      const Vector dx = hn::Load(d, chunk.dx + from), dy = hn::Load(d, chunk.dy + from),
                   dz = hn::Load(d, chunk.dz + from);
      const Vector k2 = hn::Mul(hn::Mul(k, k), r2);
      strongest2 = hn::IfThenElse(hn::Le(k2, strongest2), strongest2, k2);  // keeps what is no number
      nearest = lesser(nearest, r2);
      force[0].add(k, dx, magic);
      force[1].add(k, dy, magic);
      force[2].add(k, dz, magic);
      if (!all) continue;
      energy.add(hn::IfThenElseZero(near, hn::Load(d, chunk.energy + from)), one, energy_magic);
      const Vector kx = hn::Mul(k, dx), ky = hn::Mul(k, dy), kz = hn::Mul(k, dz);
      virial[0].add(kx, dx, energy_magic);
      virial[1].add(ky, dy, energy_magic);
      virial[2].add(kz, dz, energy_magic);
      virial[3].add(kx, dy, energy_magic);
      virial[4].add(kx, dz, energy_magic);
      virial[5].add(ky, dz, energy_magic);
    }
    for (int k = 0; k < 3; ++k) merge(force[k], force_zero, chunk.rows, sums.force[k] + half);
    if (all) {
      merge(energy, energy_zero, chunk.rows, sums.energy + half);
      for (int k = 0; k < 6; ++k) merge(virial[k], energy_zero, chunk.rows, sums.virial[k] + half);
    }
    const auto weak = hn::And(hn::Le(strongest2, limit2), hn::Ge(nearest, nearest2));
    sums.close = sums.close || !hn::AllTrue(d, weak);
    if constexpr (requires { energy.strong; }) {
      double least[lanes], most[lanes];
      hn::StoreU(nearest, d, least);
      hn::StoreU(strongest2, d, most);
      for (std::ptrdiff_t k = 0; k < lanes; ++k) {
        bool strong = energy.strong[k] || least[k] < filter.nearest2 || !(most[k] < 1e300);
        for (const Sum& sum : force) strong = strong || sum.strong[k];
        for (const Sum& sum : virial) strong = strong || sum.strong[k];
        sums.strong[half + k] = sums.strong[half + k] || strong;
      }
    }
  }
}

}  // namespace

extern const PairChunkKernels pair_chunk_kernels;
constinit const PairChunkKernels pair_chunk_kernels{load, {add<QuickSum>, add<CarefulSum>}};

}  // namespace noether::NOETHER_SIMD_LEVEL

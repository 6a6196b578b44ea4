#pragma once
/// Pairs of any potential in lanes: the interface of `pair_chunk_simd.cpp`, compiled once per SIMD level.

#include "engine/simd.hpp"
#include "forces/pair_row.hpp"

namespace noether {

/// Pairs between their distances and their forces: rows of eight.
struct alignas(64) PairChunk {
  static constexpr std::ptrdiff_t most_rows = 16, size = 8 * most_rows;
  double dx[size], dy[size], dz[size];
  double r2[size];  ///< the square of the cutoff for pairs that do not act
  double energy[size], force[size];
  std::ptrdiff_t rows;
};

/// Which pairs act.
struct PairFilter {
  const double* records;           ///< shape (records, 4): x, y, z, type as std::int64_t
  double range2;                   ///< square of the cutoff [length^2]
  double nearest2;                 ///< nearer pairs are too close [length^2]
  std::int64_t type[2];            ///< only pairs of these; -1: all
  double force_unit, energy_unit;  ///< what the sums count, powers of two
};

struct PairChunkKernels {
  /// Loads rows `first` to `first + chunk.rows` of a group.
  void (*load)(const PairFilter& filter, const PairGroup& group, std::ptrdiff_t first, PairChunk& chunk);
  /// Adds the pairs of a chunk to the sums: forces, or all; [1]: one by one, whatever their strength.
  void (*add[2])(const PairFilter& filter, const PairChunk& chunk, bool all, PairSums& sums);
};

namespace base {
extern const PairChunkKernels pair_chunk_kernels;
}
#if NOETHER_SIMD_LEVELS
namespace avx2 {
extern const PairChunkKernels pair_chunk_kernels;
}
namespace avx512 {
extern const PairChunkKernels pair_chunk_kernels;
}
#endif

/// The kernels of the level in use.
inline const PairChunkKernels& pair_chunk_kernels() {
#if NOETHER_SIMD_LEVELS
  return at_simd_level(base::pair_chunk_kernels, avx2::pair_chunk_kernels, avx512::pair_chunk_kernels);
#else
  return base::pair_chunk_kernels;
#endif
}

}  // namespace noether

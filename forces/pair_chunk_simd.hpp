#pragma once
/// Pairs of any potential in lanes: the interface of `pair_chunk_simd.cpp`, compiled once per SIMD level.

#include "forces/pair_row.hpp"
#include "numbers/kernels_simd.hpp"

namespace noether {

/// Pairs between their distances and their forces: rows of eight.
struct alignas(64) PairChunk {
  static constexpr std::ptrdiff_t most_rows = 16, size = 8 * most_rows;
  double dx[size], dy[size], dz[size];
  double r2[size];       ///< the square of the cutoff for pairs that do not act
  double product[size];  ///< of the charges of a pair, where somebody asks for it [energy length]
  double energy[size], force[size];
  std::ptrdiff_t rows;
};

/// Which pairs act, and with what charges.
struct PairFilter {
  const double* records;           ///< shape (records, 4): x, y, z, type as std::int64_t
  double range2;                   ///< square of the cutoff [length^2]
  double nearest2;                 ///< nearer pairs are too close [length^2]
  double force_unit, energy_unit;  ///< what the sums count, powers of two
  const double* charges;           ///< of the records, shape (records); null: nobody asks for them [charge]
  double coulomb_constant;         ///< times the charges of a pair [energy length/charge^2]
};

struct PairChunkKernels {
  /// Loads rows `first` to `first + chunk.rows` of a group: distances, and what charges multiply to.
  void (*load)(const PairFilter& filter, const PairGroup& group, std::ptrdiff_t first, PairChunk& chunk);
  /// Adds the pairs of a chunk to the sums. [0]: quickly, [1]: one by one, whatever their strength; [][0]: forces,
  /// [][1]: energies and virials too.
  void (*add[2][2])(const PairFilter& filter, const PairChunk& chunk, PairSums& sums);
};

NOETHER_KERNELS(PairChunkKernels, pair_chunk_kernels)

}  // namespace noether

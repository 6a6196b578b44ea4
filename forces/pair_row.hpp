#pragma once
/// Pairs in groups of eight particles, as the kernels in lanes and the loops around them see them.

#include <cstddef>
#include <cstdint>

namespace noether {

/// Eight particles and their neighbors (neighbors/neighbor_list.hpp).
struct PairGroup {
  const std::int32_t* records;  ///< where their records begin
  const std::int32_t* entries;  ///< where those of neighbors begin, shape (rows, 8)
  std::ptrdiff_t rows;
};

/// Sums over the neighbors of each particle, in whole units: they depend on no order.
struct alignas(64) PairSums {
  std::int64_t force[3][8];
  std::int64_t energy[8];     ///< of whole pairs: each counts it twice
  std::int64_t virial[6][8];  ///< xx, yy, zz, xy, xz, yz, of whole pairs
  bool close;                 ///< some pair is too close: ask the careful kernel
  bool strong[8];             ///< of the careful kernel: a particle has a pair stronger than any sum can hold
};

}  // namespace noether

#pragma once
/// Lennard-Jones pairs in lanes: the interface of `lennard_jones_simd.cpp`, compiled once per SIMD level.

#include "engine/simd.hpp"
#include "forces/lennard_jones_row.hpp"

#include <cstddef>
#include <cstdint>

namespace noether {

/// Everything that is the same for all groups.
struct PairField {
  const double* records;        ///< shape (records, 4): x, y, z, type as std::int64_t
  const LennardJonesRow* rows;  ///< shape (types, types)
  std::ptrdiff_t types;
  double force_unit, energy_unit;  ///< what the sums count, powers of two
};

/// Eight particles and their neighbors (engine/neighbor_list.hpp).
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

using SumPairs = void (*)(const PairField& field, const PairGroup& group, PairSums& sums);

/// Kernels by style, number of types (one, or more) and what is summed (forces, or all).
struct LennardJonesKernels {
  int lanes;
  SumPairs quick[4][2][2];
  SumPairs careful[4][2][2];
};

namespace base {
extern const LennardJonesKernels lennard_jones_kernels;
}
#if NOETHER_SIMD_LEVELS
namespace avx2 {
extern const LennardJonesKernels lennard_jones_kernels;
}
namespace avx512 {
extern const LennardJonesKernels lennard_jones_kernels;
}
#endif

/// The kernels of the level in use.
inline const LennardJonesKernels& lennard_jones_kernels() {
#if NOETHER_SIMD_LEVELS
  return at_simd_level(base::lennard_jones_kernels, avx2::lennard_jones_kernels, avx512::lennard_jones_kernels);
#else
  return base::lennard_jones_kernels;
#endif
}

}  // namespace noether

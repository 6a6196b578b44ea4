#pragma once
/// Lennard-Jones pairs in lanes: the interface of `lennard_jones_simd.cpp`, compiled once per SIMD level.

#include "engine/simd.hpp"

#include <cstddef>
#include <cstdint>

namespace noether {

/// How a pair of types acts: one row of a table.
struct LennardJonesRow {
  double range2 = 0;                 ///< square of the cutoff [length^2]
  double close2 = 0;                 ///< nearer pairs may be too strong for the grid of the sums [length^2]
  double force12 = 0, force6 = 0;    ///< F/r = (force12 / r^6 - force6) / r^8
  double energy12 = 0, energy6 = 0;  ///< U = (energy12 / r^6 - energy6) / r^6
  double style[2] = {0, 0};          ///< see LennardJonesStyle
};

/// What the end of the range does, and the numbers of a row that it needs.
enum class LennardJonesStyle : std::uint8_t {
  shifted,        ///< energy less style[0]; plain where that is 0
  shifted_force,  ///< energy less style[0], less the force style[1] times r; style[0] takes both
  switch_c2,      ///< from r^2 = style[0] on times a polynomial in (r^2 - style[0]) style[1], twice differentiable
  switch_c4,      ///< the same, four times differentiable
};

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

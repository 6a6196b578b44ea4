#pragma once
/// Lennard-Jones pairs in lanes: the interface of `lennard_jones_simd.cpp`, compiled once per SIMD level.

#include "forces/lennard_jones_row.hpp"
#include "forces/pair_row.hpp"
#include "numbers/kernels_simd.hpp"

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

using SumPairs = void (*)(const PairField& field, const PairGroup& group, PairSums& sums);

/// Kernels by style, number of types (one, or more) and what is summed (forces, or all).
struct LennardJonesKernels {
  int lanes;
  SumPairs quick[4][2][2];
  SumPairs careful[4][2][2];
};

NOETHER_KERNELS(LennardJonesKernels, lennard_jones_kernels)

}  // namespace noether

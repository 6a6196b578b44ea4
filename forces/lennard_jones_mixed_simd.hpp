#pragma once
/// Lennard-Jones forces in lanes of single precision: the interface of `lennard_jones_mixed_simd.cpp`, compiled once
/// per SIMD level.

#include "forces/lennard_jones_row.hpp"
#include "forces/pair_row.hpp"
#include "numbers/kernels_simd.hpp"

#include <cstddef>
#include <cstdint>

namespace noether {

/// Everything that is the same for all groups. Lengths are in the unit of the records, forces in those of the sums.
struct MixedPairField {
  const std::int32_t* records;  ///< shape (records, 4): x, y, z in whole numbers, and the type
  const LennardJonesRow* rows;  ///< shape (types, types): by 1/r^2 times `inverse2_unit`
  std::ptrdiff_t types;
  double inverse2_unit;
};

using SumMixedPairs = void (*)(const MixedPairField& field, const PairGroup& group, PairSums& sums);

/// Kernels by style and number of types (one, or more). They sum forces alone.
struct LennardJonesMixedKernels {
  SumMixedPairs quick[4][2];
  SumMixedPairs careful[4][2];
};

NOETHER_KERNELS(LennardJonesMixedKernels, lennard_jones_mixed_kernels)

}  // namespace noether

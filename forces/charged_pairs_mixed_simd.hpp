#pragma once
/// Charges of short range in lanes of single precision: the interface of `charged_pairs_mixed_simd.cpp`, compiled once
/// per SIMD level.

#include "forces/charge_series_row.hpp"
#include "forces/pair_row.hpp"
#include "numbers/kernels_simd.hpp"

#include <cstddef>
#include <cstdint>

namespace noether {

/// Everything that is the same for all groups. The series is one of lengths in whole numbers' units.
struct MixedChargedField {
  const std::int32_t* records;  ///< shape (records, 4): x, y, z in whole numbers, and the bits of a charge
  const ChargeSeries* series;
  double close2;  ///< nearer pairs may be too strong for quick sums
};

/// The same of molecules of three charged sites each, between which no pair is left out. Groups, rows and records are
/// those of molecules.
struct MixedMoleculeField {
  const std::int32_t* records;  ///< shape (records, 3, 4): x, y, z of the sites, and a number that nobody reads
  float charges[3];
  const ChargeSeries* series;
  double close2;  ///< see MixedChargedField
};

using SumMixedCharges = void (*)(const MixedChargedField& field, const PairGroup& group, PairSums& sums);

/// @param sums  of the three sites; the first tells whether any of them is close
using SumMixedMolecules = void (*)(const MixedMoleculeField& field, const PairGroup& group, PairSums* sums);

/// Kernels by what the series is, as ChargedPairKernels. They sum forces alone.
struct ChargedPairMixedKernels {
  /// Forces of quick sums are below so many units.
  static constexpr double most = 0x1.8p27, most_of_molecules = 0x1.fp25;

  SumMixedCharges quick[3];
  SumMixedCharges careful[3];
  SumMixedMolecules quick_molecules[3];
  SumMixedMolecules careful_molecules[3];
};

NOETHER_KERNELS(ChargedPairMixedKernels, charged_pair_mixed_kernels)

}  // namespace noether

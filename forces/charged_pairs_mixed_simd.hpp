#pragma once
/// Charges of short range in lanes of single precision: the interface of `charged_pairs_mixed_simd.cpp`, compiled once
/// per SIMD level.

#include "forces/charge_series_row.hpp"
#include "forces/pair_row.hpp"
#include "numbers/kernels_simd.hpp"

#include <cstddef>
#include <cstdint>

namespace noether {

/// Everything that is the same for all groups. The series is one of lengths in a unit near the range.
struct MixedChargedField {
  const std::int32_t* records;  ///< shape (records, 4): x, y, z in whole numbers, and the bits of a charge
  const ChargeSeries* series;
  double length2;  ///< square of a whole number's length, in the unit of the series
  double close2;   ///< nearer pairs may be too strong for quick sums, in that unit
};

using SumMixedCharges = void (*)(const MixedChargedField& field, const PairGroup& group, PairSums& sums);

/// Kernels by what the series is, as ChargedPairKernels. They sum forces alone.
struct ChargedPairMixedKernels {
  SumMixedCharges quick[3];
  SumMixedCharges careful[3];
};

NOETHER_KERNELS(ChargedPairMixedKernels, charged_pair_mixed_kernels)

}  // namespace noether

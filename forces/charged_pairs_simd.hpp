#pragma once
/// Charges of short range in lanes: the interface of `charged_pairs_simd.cpp`, compiled once per SIMD level.

#include "forces/charge_series_row.hpp"
#include "forces/pair_row.hpp"
#include "numbers/kernels_simd.hpp"

namespace noether {

/// Everything that is the same for all groups.
struct ChargedPairField {
  const double* records;  ///< shape (records, 4): x, y, z, and a charge whose product with another is an energy length
  const ChargeSeries* series;
  double close2;                   ///< nearer pairs may be too strong for the grid of the sums [length^2]
  double force_unit, energy_unit;  ///< what the sums count, powers of two
};

using SumChargedPairs = void (*)(const ChargedPairField& field, const PairGroup& group, PairSums& sums);

/// Kernels by what the series is (of r^2 itself two terms of the energy and one of the force, the same with a switch,
/// any without one) and what is summed (forces, all).
struct ChargedPairKernels {
  SumChargedPairs quick[3][2];
  SumChargedPairs careful[3][2];
};

NOETHER_KERNELS(ChargedPairKernels, charged_pair_kernels)

}  // namespace noether

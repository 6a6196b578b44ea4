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

/// The same of molecules of three charged sites each, between which no pair is left out. Groups, rows and records are
/// those of molecules.
struct ChargedMoleculeField {
  const double* records;  ///< shape (records, 3, 4): x, y, z of the sites, and a number that nobody reads
  double products[3][3];  ///< of the charges of two sites [energy length]
  const ChargeSeries* series;
  double close2;                   ///< see ChargedPairField
  double force_unit, energy_unit;  ///<
};

using SumChargedPairs = void (*)(const ChargedPairField& field, const PairGroup& group, PairSums& sums);

/// @param sums  of the three sites; the first tells whether any of them is close
using SumChargedMolecules = void (*)(const ChargedMoleculeField& field, const PairGroup& group, PairSums* sums);

/// Kernels by what the series is (of r^2 itself two terms of the energy and one of the force, the same with a switch,
/// any without one) and what is summed (forces, all).
struct ChargedPairKernels {
  SumChargedPairs quick[3][2];
  SumChargedPairs careful[3][2];
  SumChargedMolecules quick_molecules[3][2];
  SumChargedMolecules careful_molecules[3][2];
};

NOETHER_KERNELS(ChargedPairKernels, charged_pair_kernels)

}  // namespace noether

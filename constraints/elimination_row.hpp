#pragma once
/// The order in which the constraints of a molecule are eliminated, as plain lists that kernels in lanes read.

namespace noether {

/// An atom on which constraints hang. Those that it *owns* stand side by side: first those to its leaves, atoms of one
/// constraint alone, then those to centers that are eliminated before it.
struct EliminationCenter {
  int atom;
  int first, leaves_end, end;  ///< the constraints it owns
  int out_begin, out_end;      ///< in `outgoing`: constraints that later centers own
  double inverse_mass;
};

/// Constraints of a molecule in the order of elimination: k leads from its center, atom j[k], to atom i[k].
///
/// The matrix couples two constraints that share an atom. Its factor L has rows of `entries`, columns ascending; where
/// one is fill, the molecule has rings.
struct EliminationLists {
  int atoms, constraints, entries, centers, longest_row;
  const EliminationCenter* center;
  const int* given;  ///< the constraints in the order in which the molecule has them
  const int *i, *j;  ///< atoms of each constraint
  const double *inverse_mass, *inverse_mass_i, *inverse_mass_j;  ///< of atoms; of the atoms of constraints
  const int *outgoing, *center_of;                               ///< of an atom, or -1
  const int *row, *column;                                       ///< entries of each row of L; the column of each entry
  const double* coupling;                             ///< of an entry: sign times inverse mass; 0 where it is fill
  const int *product, *product_left, *product_right;  ///< of an entry: sum over row[left] L[right]
  const int *below, *below_row, *below_entry;         ///< L by columns
};

}  // namespace noether

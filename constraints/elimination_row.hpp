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

/// Which constraints a center of a tree has: those it owns, `leaves` and `inner` ones, the last of these to the center
/// just before it; and whether a later center owns one (`out`), which is then the `next` one and has it for its last.
struct TreeShape {
  int leaves, inner;
  bool out, next;

  constexpr int code() const { return ((leaves * 4 + inner) * 2 + (out ? 1 : 0)) * 2 + (next ? 1 : 0); }
  static constexpr int codes = 4 * 4 * 2 * 2;
  static constexpr TreeShape of(int code) { return {code / 16, code / 4 % 4, code / 2 % 2 != 0, code % 2 != 0}; }
  /// Whether there are such centers in trees of several, with at most four bonds an atom.
  constexpr bool exists() const {
    if (out) return leaves + inner > 0 && leaves + inner < 4;
    return !next && inner == 1 && leaves > 0 && leaves < 4;
  }
};
/// A center of a tree as its kernels read it.
struct TreeCenter {
  int number;
  int shape;      ///< code
  int first;      ///< the constraints it owns, leaves first
  int out;        ///< the one that a later center owns
  int entry;      ///< where its factors begin
  int before[2];  ///< the centers of its inner constraints but the last
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

#pragma once
/// The order in which the constraints of a molecule are eliminated.

#include "constraints/elimination_row.hpp"
#include "numbers/types.hpp"

#include <set>
#include <span>
#include <utility>
#include <vector>

namespace noether {

/// Symbolic factorisation L D L^T of the matrix G M^-1 G^T of one molecule whose constraints are distances: made once
/// for all molecules of a kind.
///
/// The matrix couples constraints that share an atom: its graph is the line graph of that of the bonds. A tree of bonds
/// is walked from the outside to the inside and has no fill; of rings the center with the fewest neighbors is taken
/// first.
/// @source Davis2006
class Elimination {
 public:
  using Pair = std::pair<int, int>;

  /// @param pairs  of atoms, each pair once
  /// @param inverse_masses  of atoms
  /// @cost O(c^2 log c) for c constraints
  Elimination(std::span<const Pair> pairs, std::vector<double> inverse_masses);

  /// Valid as long as this is where it is.
  EliminationLists lists() const;
  /// Which of `pairs` each constraint is, in the order of elimination.
  const std::vector<int>& places() const { return place_; }
  /// Entries of L that the matrix does not have.
  int fill() const { return fill_; }

 private:
  using Graph = std::vector<std::set<int>>;

  static std::vector<int> order_of_tree(const Graph& centers, int any);
  static std::vector<int> order_of_rings(Graph centers);
  void own_constraints(std::span<const Pair> pairs, const std::vector<int>& order);
  void find_entries();
  double coupling_of(int k, int l) const;

  std::vector<double> inverse_mass_, inverse_mass_i_, inverse_mass_j_, coupling_;
  std::vector<EliminationCenter> center_;
  std::vector<int> i_, j_, place_, given_, outgoing_, center_of_;
  std::vector<int> row_, column_, product_, product_left_, product_right_, below_, below_row_, below_entry_;
  int fill_ = 0, longest_row_ = 0;
};

}  // namespace noether

#pragma once
/// Molecules whose bonds form a tree.

#include "constraints/elimination_row.hpp"

#include <vector>

namespace noether {

/// The centers of a tree in the order of elimination. @return none if all bonds hang on one
/// atom, if they have a ring, or if an atom has more than four
std::vector<TreeCenter> tree_centers(const EliminationLists& lists);

}  // namespace noether

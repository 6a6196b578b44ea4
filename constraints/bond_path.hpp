#pragma once
/// Molecules whose bonds form one path.

#include "constraints/molecule_row.hpp"

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace noether {

/// An unbranched molecule from one end to the other.
struct BondPath {
  std::vector<int> atoms;              ///< shape (bonds + 1)
  std::vector<int> bonds;              ///< which of the pairs leads from atoms[k] to atoms[k + 1]
  std::vector<double> inverse_masses;  ///< of `atoms`

  /// Valid as long as this is where it is.
  BondPathRow row() const {
    return {.bonds = static_cast<int>(bonds.size()), .atom = atoms.data(), .inverse_mass = inverse_masses.data()};
  }
};

/// @param pairs  of atoms, each pair once, that hang together
/// @param inverse_masses  of atoms
/// @return nothing if an atom has more than two bonds, or the bonds form a ring
std::optional<BondPath> bond_path(std::span<const std::pair<int, int>> pairs,
                                  const std::vector<double>& inverse_masses);

}  // namespace noether

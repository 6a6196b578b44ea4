#pragma once
/// Who is bonded to whom. Its place is the engine: files read it, forces and constraints use it, and these three rooms
/// do not see each other.

#include "engine/types.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// One bonded term: its particles and the index of its type's parameters.
template <std::size_t n> struct BondedTerm {
  std::array<Index, n> particles{};
  int type = 0;

  bool operator==(const BondedTerm&) const = default;
};

/// Types, molecules and bonded terms of a system, by particle index, and the pairs they take out of pair forces.
///
/// Plain lists in the order of their file: what is computed from them has one order, so its bits do not change.
struct Topology {
  std::vector<std::string> type_names;  ///< by type
  std::vector<std::int64_t> types;      ///< type of each particle, shape (n)
  std::vector<std::int64_t> molecules;  ///< molecule of each particle, shape (n)
  std::vector<BondedTerm<2>> bonds;
  std::vector<BondedTerm<3>> angles;  ///< the vertex in the middle
  std::vector<BondedTerm<4>> dihedrals, impropers;

  using Pair = std::pair<Index, Index>;  ///< the smaller index first
  std::vector<Pair> exclusions;          ///< pairs without pair force, sorted
  std::vector<Pair> pairs_14;            ///< pairs of scaled force, sorted

  /// Number of bonds on the shortest path between particles up to `most` apart, sorted by pair.
  /// @param n  number of particles; every bond lies in [0, n)
  /// @throws LogicError  if a bond names a particle that is not there
  /// @cost O(n b^most) with b bonds per particle
  struct Separated {
    Pair pair;
    int bonds;
  };
  std::vector<Separated> bond_separations(Index n, int most) const;

  /// Excludes the pairs up to `bonds` bonds apart (3 at most) and lists pairs three bonds apart as 1-4 pairs if they
  /// are not excluded.
  void exclude_by_bonds(Index n, int bonds);
};

}  // namespace noether

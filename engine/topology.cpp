#include "engine/topology.hpp"

#include "engine/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace noether {

namespace {

using Neighbors = std::vector<std::vector<Index>>;

Neighbors neighbors_of(const std::vector<BondedTerm<2>>& bonds, Index n) {
  Neighbors neighbors(static_cast<std::size_t>(n));
  for (const auto& bond : bonds) {
    const auto [i, j] = bond.particles;
    NOETHER_EXPECTS(i >= 0 && j >= 0 && i < n && j < n && i != j,
                    fmt::format("a bond joins particles {} and {}, but there are {}", i, j, n));
    neighbors[static_cast<std::size_t>(i)].push_back(j);
    neighbors[static_cast<std::size_t>(j)].push_back(i);
  }
  return neighbors;
}

}  // namespace

std::vector<Topology::Separated> Topology::bond_separations(Index n, int most) const {
  const Neighbors neighbors = neighbors_of(bonds, n);
  std::vector<Separated> found;
  for (Index i = 0; i < n; ++i) {
    std::vector<Index> seen = {i}, shell = {i};
    for (int distance = 1; distance <= most; ++distance) {
      std::vector<Index> next;
      for (const Index j : shell) {
        for (const Index k : neighbors[static_cast<std::size_t>(j)]) {
          if (std::find(seen.begin(), seen.end(), k) != seen.end()) continue;
          seen.push_back(k);
          next.push_back(k);
          if (i < k) found.push_back({{i, k}, distance});
        }
      }
      shell = std::move(next);
    }
  }
  std::sort(found.begin(), found.end(), [](const Separated& a, const Separated& b) { return a.pair < b.pair; });
  return found;
}

void Topology::exclude_by_bonds(Index n, int bonds_apart) {
  NOETHER_EXPECTS(bonds_apart >= 0 && bonds_apart <= 3,
                  fmt::format("pairs cannot be excluded up to {} bonds; 0 to 3 is expected", bonds_apart));
  exclusions.clear();
  pairs_14.clear();
  for (const Separated& one : bond_separations(n, 3)) {
    if (one.bonds <= bonds_apart) {
      exclusions.push_back(one.pair);
    } else if (one.bonds == 3) {
      pairs_14.push_back(one.pair);
    }
  }
}

}  // namespace noether

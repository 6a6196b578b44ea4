#include "engine/topology.hpp"

#include "numbers/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

namespace noether {

namespace {

using Neighbors = std::vector<std::vector<Index>>;

Neighbors neighbors_of(const std::vector<BondedTerm<2>>& bonds, Index n) {
  Neighbors neighbors(static_cast<std::size_t>(n));
  for (const auto& bond : bonds) {
    const auto [i, j] = bond.particles;
    NOETHER_EXPECTS(i >= 0 && j >= 0 && i < n && j < n && i != j,
                    fmt::format("a bond joins particles {} and {}, but there are only {} particles", i, j, n));
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

void Topology::scale_by_bonds(Index n, const std::array<double, 3>& factors) {
  exclusions.clear();
  scaled_pairs.clear();
  for (const Separated& one : bond_separations(n, 3)) {
    const double factor = factors[static_cast<std::size_t>(one.bonds - 1)];
    if (factor == 0) {
      exclusions.push_back(one.pair);
    } else if (factor != 1) {
      scaled_pairs.push_back({one.pair, factor});
    }
  }
}

void Topology::exclude(const std::vector<Pair>& pairs) {
  for (const Pair& pair : pairs) exclusions.emplace_back(std::minmax(pair.first, pair.second));
  std::sort(exclusions.begin(), exclusions.end());
  exclusions.erase(std::unique(exclusions.begin(), exclusions.end()), exclusions.end());
  std::erase_if(scaled_pairs, [&](const ScaledPair& scaled) {
    return std::binary_search(exclusions.begin(), exclusions.end(), scaled.pair);
  });
}

Topology Topology::without_rigid_terms(Index n) const {
  std::vector<std::vector<std::size_t>> groups_of(static_cast<std::size_t>(n));  // ascending
  const auto groups = [&](Index i) -> std::vector<std::size_t>& {
    NOETHER_EXPECTS(i >= 0 && i < n, fmt::format("particle {} is held or bonded, but there are only {}", i, n));
    return groups_of[static_cast<std::size_t>(i)];
  };
  for (std::size_t g = 0; g < rigid.size(); ++g) {
    for (const Index i : rigid[g]) groups(i).push_back(g);
  }
  const auto is_rigid = [&](const auto& term) {
    std::vector<std::size_t> common = groups(term.particles[0]);
    for (std::size_t k = 1; k < term.particles.size() && !common.empty(); ++k) {
      const std::vector<std::size_t>& others = groups(term.particles[k]);
      std::erase_if(common, [&](std::size_t g) { return !std::binary_search(others.begin(), others.end(), g); });
    }
    return !common.empty();
  };
  Topology rest = *this;
  rest.rigid.clear();
  std::erase_if(rest.bonds, is_rigid);
  std::erase_if(rest.angles, is_rigid);
  std::erase_if(rest.dihedrals, is_rigid);
  std::erase_if(rest.impropers, is_rigid);
  return rest;
}

bool Topology::has_dihedral_kinds() const {
  return std::all_of(dihedrals.begin(), dihedrals.end(), [&](const BondedTerm<4>& term) {
    return static_cast<std::size_t>(term.type) < dihedral_kinds.size();
  });
}

bool Topology::is_special(Index i, Index j) const { return pair_factor(i, j) != 1; }

double Topology::pair_factor(Index i, Index j) const {
  const Pair pair(std::min(i, j), std::max(i, j));
  if (std::binary_search(exclusions.begin(), exclusions.end(), pair)) return 0;
  const auto found = std::lower_bound(scaled_pairs.begin(), scaled_pairs.end(), pair,
                                      [](const ScaledPair& one, const Pair& wanted) { return one.pair < wanted; });
  return found != scaled_pairs.end() && found->pair == pair ? found->factor : 1;
}

int Topology::type_count() const {
  const auto largest = std::max_element(types.begin(), types.end());
  const int used = largest == types.end() ? 1 : static_cast<int>(*largest) + 1;
  return std::max({used, static_cast<int>(type_names.size()), static_cast<int>(pair_kinds.size())});
}

PairKind mix(Mixing rule, const PairKind& a, const PairKind& b) {
  const double sigma = rule == Mixing::geometric ? std::sqrt(a.sigma * b.sigma) : (a.sigma + b.sigma) / 2;
  return {std::sqrt(a.epsilon * b.epsilon), sigma};
}

PairKind Topology::pair_kind(int a, int b) const {
  const auto found = explicit_pairs.find({std::min(a, b), std::max(a, b)});
  if (found != explicit_pairs.end()) return found->second;
  for (const int type : {a, b}) {
    if (type < static_cast<int>(pair_kinds.size())) continue;
    throw Error(
        fmt::format("particles of type {} have no Lennard-Jones parameters; give epsilon and sigma for it", type));
  }
  const PairKind& one = pair_kinds[static_cast<std::size_t>(a)];
  return a == b ? one : mix(mixing, one, pair_kinds[static_cast<std::size_t>(b)]);
}

std::vector<Index> molecules_by_number(const Topology& topology, Index n) {
  std::vector<Index> first(static_cast<std::size_t>(n));
  std::iota(first.begin(), first.end(), Index(0));
  std::unordered_map<std::int64_t, Index> known;
  for (Index i = 0; i < static_cast<Index>(topology.molecules.size()); ++i) {
    const std::int64_t number = topology.molecules[static_cast<std::size_t>(i)];
    if (number != 0) first[static_cast<std::size_t>(i)] = known.emplace(number, i).first->second;
  }
  return first;
}

std::vector<Index> molecules_by_bonds(const Topology& topology, Index n) {
  std::vector<Index> above(static_cast<std::size_t>(n));
  std::iota(above.begin(), above.end(), Index(0));
  const auto root = [&](Index i) {
    while (above[static_cast<std::size_t>(i)] != i) {
      Index& next = above[static_cast<std::size_t>(i)];
      i = next = above[static_cast<std::size_t>(next)];
    }
    return i;
  };
  for (const BondedTerm<2>& bond : topology.bonds) {
    const Index a = root(bond.particles[0]), b = root(bond.particles[1]);
    above[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  for (Index i = 0; i < n; ++i) above[static_cast<std::size_t>(i)] = root(i);
  return above;
}

}  // namespace noether

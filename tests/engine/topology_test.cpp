#include "engine/topology.hpp"
#include "numbers/error.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>

using noether::Topology;

namespace {

using Pairs = std::vector<Topology::Pair>;

/// Butane's carbons in a row, and a ring of four beside it.
Topology chain_and_ring() {
  Topology topology;
  for (const auto& [i, j] : {std::pair{0, 1}, {1, 2}, {2, 3}, {4, 5}, {5, 6}, {6, 7}, {7, 4}}) {
    topology.bonds.push_back({{i, j}, 0});
  }
  return topology;
}

}  // namespace

TEST_CASE("pairs are excluded or scaled by the number of bonds between them", "[topology]") {
  Topology topology = chain_and_ring();
  topology.scale_by_bonds(8, {0, 0, 0.5});
  CHECK(topology.exclusions ==
        Pairs{{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}, {4, 5}, {4, 6}, {4, 7}, {5, 6}, {5, 7}, {6, 7}});
  CHECK(topology.scaled_pairs == std::vector<Topology::ScaledPair>{{{0, 3}, 0.5}});
}

TEST_CASE("a factor of 1 leaves a pair alone, a factor of 0 excludes it", "[topology]") {
  Topology topology = chain_and_ring();
  topology.scale_by_bonds(8, {0, 1, 1});
  CHECK(topology.scaled_pairs.empty());
  CHECK(topology.exclusions.size() == topology.bonds.size());
  topology.scale_by_bonds(8, {0, 0, 0});
  CHECK(topology.scaled_pairs.empty());
  CHECK(topology.exclusions.size() == 12);
}

TEST_CASE("pairs that are excluded by themselves add to those by bonds, and are scaled no more", "[topology]") {
  Topology topology = chain_and_ring();
  topology.scale_by_bonds(8, {0, 0, 0.5});
  const Pairs by_bonds = topology.exclusions;
  topology.exclude({{6, 1}, {3, 0}, {1, 0}});
  Pairs all = by_bonds;
  all.insert(all.end(), {{0, 3}, {1, 6}});
  std::sort(all.begin(), all.end());
  CHECK(topology.exclusions == all);
  CHECK(topology.scaled_pairs.empty());
  CHECK(topology.is_special(6, 1));
}

TEST_CASE("a ring takes the shorter way round", "[topology]") {
  for (const auto& one : chain_and_ring().bond_separations(8, 3)) {
    if (one.pair == Topology::Pair{4, 7}) CHECK(one.bonds == 1);
    if (one.pair == Topology::Pair{5, 7}) CHECK(one.bonds == 2);
  }
}

TEST_CASE("parameters of a pair of types are mixed by the rule, unless they were given", "[topology]") {
  Topology topology;
  topology.pair_kinds = {{1, 2}, {4, 8}};
  CHECK(topology.type_count() == 2);
  CHECK(topology.pair_kind(0, 0) == noether::PairKind{1, 2});
  CHECK(topology.pair_kind(1, 0) == noether::PairKind{2, 5});
  topology.mixing = noether::Mixing::geometric;
  CHECK(topology.pair_kind(0, 1) == noether::PairKind{2, 4});
  topology.explicit_pairs[{0, 1}] = {3, 7};
  CHECK(topology.pair_kind(1, 0) == noether::PairKind{3, 7});
  CHECK_THROWS_WITH(topology.pair_kind(0, 2),
                    "particles of type 2 have no Lennard-Jones parameters; give epsilon and sigma for it");
}

TEST_CASE("a bond to a particle that is not there is refused by name", "[topology]") {
  Topology topology;
  topology.bonds.push_back({{0, 9}, 0});
  CHECK_THROWS_WITH(topology.scale_by_bonds(2, {0, 0, 1}),
                    "a bond joins particles 0 and 9, but there are only 2 particles");
}

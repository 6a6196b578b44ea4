#include "engine/topology.hpp"
#include "engine/error.hpp"
#include "tests/support/catch.hpp"

using noether::Topology;

namespace {

/// Butane's carbons in a row, and a ring of four beside it.
Topology chain_and_ring() {
  Topology topology;
  for (const auto& [i, j] : {std::pair{0, 1}, {1, 2}, {2, 3}, {4, 5}, {5, 6}, {6, 7}, {7, 4}}) {
    topology.bonds.push_back({{i, j}, 0});
  }
  return topology;
}

}  // namespace

TEST_CASE("pairs up to two bonds apart are excluded and three bonds make a 1-4 pair", "[topology]") {
  Topology topology = chain_and_ring();
  topology.exclude_by_bonds(8, 2);
  using Pairs = std::vector<Topology::Pair>;
  CHECK(topology.exclusions ==
        Pairs{{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}, {4, 5}, {4, 6}, {4, 7}, {5, 6}, {5, 7}, {6, 7}});
  CHECK(topology.pairs_14 == Pairs{{0, 3}});
}

TEST_CASE("with three bonds excluded no 1-4 pair is left", "[topology]") {
  Topology topology = chain_and_ring();
  topology.exclude_by_bonds(8, 3);
  CHECK(topology.pairs_14.empty());
  CHECK(topology.exclusions.size() == 12);
}

TEST_CASE("a ring takes the shorter way round", "[topology]") {
  for (const auto& one : chain_and_ring().bond_separations(8, 3)) {
    if (one.pair == Topology::Pair{4, 7}) CHECK(one.bonds == 1);
    if (one.pair == Topology::Pair{5, 7}) CHECK(one.bonds == 2);
  }
}

TEST_CASE("a bond to a particle that is not there is refused by name", "[topology]") {
  Topology topology;
  topology.bonds.push_back({{0, 9}, 0});
  CHECK_THROWS_WITH(topology.exclude_by_bonds(2, 2), "a bond joins particles 0 and 9, but there are 2");
}

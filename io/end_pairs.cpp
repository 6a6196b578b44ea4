// Pair forces between the ends of dihedrals, where they are others than those of other pairs.
#include "engine/charge.hpp"
#include "io/structure_parts.hpp"

#include <algorithm>

namespace noether::io {

namespace {

/// Particles one to four of the first path of three bonds from `i` to `j`.
std::array<Index, 4> path_between(const std::vector<std::vector<Index>>& neighbors, Index i, Index j) {
  const auto& of_last = neighbors[static_cast<std::size_t>(j)];
  for (const Index second : neighbors[static_cast<std::size_t>(i)]) {
    for (const Index third : neighbors[static_cast<std::size_t>(second)]) {
      if (third != i && std::find(of_last.begin(), of_last.end(), third) != of_last.end()) return {i, second, third, j};
    }
  }
  return {i, i, j, j};  // never: they are three bonds apart
}

}  // namespace

std::vector<Structure::EndPair> pairs_three_bonds_apart(const Topology& topology, Index n, double lennard_jones,
                                                        double charges) {
  std::vector<std::vector<Index>> neighbors(static_cast<std::size_t>(n));
  for (const BondedTerm<2>& bond : topology.bonds) {
    const auto [i, j] = bond.particles;
    neighbors[static_cast<std::size_t>(i)].push_back(j);
    neighbors[static_cast<std::size_t>(j)].push_back(i);
  }
  std::vector<Structure::EndPair> pairs;
  for (const Topology::Separated& one : topology.bond_separations(n, 3)) {
    if (one.bonds != 3) continue;
    pairs.push_back({path_between(neighbors, one.pair.first, one.pair.second), lennard_jones, charges});
  }
  return pairs;
}

void add_end_pairs(const TextFile& text, const Structure& structure, const ParticleSystem<double>& s,
                   Topology& topology) {
  if (structure.end_pairs.empty()) return;
  if (!topology.has_dihedral_kinds()) {
    text.fail(0,
              "the ends of dihedrals interact as pairs, but there are no parameters for the kinds of the dihedrals; "
              "give the parameters of each kind in section 'Dihedral Coeffs'");
  }
  Topology ends;  // mixes their parameters
  ends.pair_kinds = structure.end_kinds.empty() ? topology.pair_kinds : structure.end_kinds;
  ends.explicit_pairs = structure.end_kinds.empty() ? topology.explicit_pairs : structure.explicit_end_kinds;
  ends.mixing = topology.mixing;
  if (ends.pair_kinds.empty()) {
    text.fail(0,
              "the ends of dihedrals interact as pairs, but types have no epsilon and sigma for them; give both in "
              "section 'Pair Coeffs' or [[particles.type]]");
  }
  std::map<std::array<double, 3>, int> known;
  for (const auto& [particles, lennard_jones, charges] : structure.end_pairs) {
    const Index i = particles.front(), j = particles.back();
    const PairKind pair = ends.pair_kind(topology.type(i), topology.type(j));
    const double product =
        s.has<Charge>() ? s.units().coulomb_constant * s.column<Charge>()[i] * s.column<Charge>()[j] : 0;
    const std::array<double, 3> parameters = {lennard_jones * pair.epsilon, pair.sigma, charges * product};
    const auto [at, fresh] = known.try_emplace(parameters, static_cast<int>(topology.dihedral_kinds.size()));
    if (fresh) topology.dihedral_kinds.push_back({"one_four", {parameters.begin(), parameters.end()}});
    topology.dihedrals.push_back({particles, at->second});
  }
}

}  // namespace noether::io

#include "constraints/structure_constraints.hpp"

#include "constraints/distance.hpp"
#include "constraints/hydrogens.hpp"
#include "constraints/rigid_frames.hpp"
#include "engine/topology.hpp"
#include "numbers/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>

namespace noether {

namespace {

using Pair = std::pair<Index, Index>;
using Particles = std::vector<Index>;

/// Where the potential of a bond is least [length]; empty where the kind does not say, or is not known.
std::optional<double> length_of(const Topology& topology, const BondedTerm<2>& bond) {
  if (bond.type < 0 || bond.type >= std::ssize(topology.bond_kinds)) return {};
  const TermKind& kind = topology.bond_kinds[static_cast<std::size_t>(bond.type)];
  if (kind.potential == "harmonic" && kind.parameters.size() == 2) return kind.parameters[1];
  if (kind.potential == "morse" && kind.parameters.size() == 3) return kind.parameters[2];
  return {};
}

/// Where the potential of an angle is least [rad]; empty as above.
std::optional<double> angle_of(const Topology& topology, const BondedTerm<3>& angle) {
  if (angle.type < 0 || angle.type >= std::ssize(topology.angle_kinds)) return {};
  const TermKind& kind = topology.angle_kinds[static_cast<std::size_t>(angle.type)];
  const bool has_one =
      kind.potential == "harmonic" || kind.potential == "cosine_squared" || kind.potential == "urey_bradley";
  return has_one && kind.parameters.size() >= 2 ? std::optional(kind.parameters[1]) : std::nullopt;
}

using Lengths = std::map<Pair, std::optional<double>>;

/// The lengths of all bonds, by pair.
Lengths bond_lengths(const Topology& topology) {
  Lengths lengths;
  for (const BondedTerm<2>& bond : topology.bonds) {
    lengths.emplace(std::minmax(bond.particles[0], bond.particles[1]), length_of(topology, bond));
  }
  return lengths;
}

/// Adds the distances between the ends of angles whose bonds are in `lengths`, unless they are there already.
void add_ends_of_angles(const Topology& topology, Lengths& lengths) {
  const Lengths bonds = lengths;
  for (const BondedTerm<3>& angle : topology.angles) {
    const auto [i, j, k] = angle.particles;
    const auto one = bonds.find(std::minmax(i, j)), other = bonds.find(std::minmax(k, j));
    if (one == bonds.end() || other == bonds.end()) continue;
    std::optional<double> length;
    if (const auto theta = angle_of(topology, angle); theta && one->second && other->second) {
      const double a = *one->second, b = *other->second;
      length = std::sqrt(a * a + b * b - 2 * a * b * std::cos(*theta));
    }
    lengths.emplace(std::minmax(i, k), length);
  }
}

std::vector<HeldDistance> as_list(const Lengths& lengths) {
  std::vector<HeldDistance> list;
  for (const auto& [pair, length] : lengths) list.push_back({{pair.first, pair.second}, length});
  return list;
}

/// Keeps the bonds that end in a hydrogen.
void keep_hydrogens(const ParticleSystem<double>& s, Lengths& lengths) {
  std::erase_if(lengths, [&](const auto& bond) {
    const auto [i, j] = bond.first;
    return !(is_hydrogen(s, i) || is_hydrogen(s, j));
  });
  if (!lengths.empty()) return;
  throw BadConstraints("no bond of the structure ends in a hydrogen, so there is nothing to be held; use bonds");
}

/// Particles that bonds connect, each list ascending, those alone too.
std::vector<Particles> bonded_components(const Topology& topology, Index n) {
  Particles above(static_cast<std::size_t>(n));
  std::iota(above.begin(), above.end(), Index(0));
  const auto root = [&](Index i) {
    while (above[static_cast<std::size_t>(i)] != i) {
      i = above[static_cast<std::size_t>(i)] = above[static_cast<std::size_t>(above[static_cast<std::size_t>(i)])];
    }
    return i;
  };
  for (const BondedTerm<2>& bond : topology.bonds) {
    const Index a = root(bond.particles[0]), b = root(bond.particles[1]);
    above[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  std::map<Index, Particles> components;
  for (Index i = 0; i < n; ++i) components[root(i)].push_back(i);
  std::vector<Particles> list;
  for (auto& [first, particles] : components) list.push_back(std::move(particles));
  return list;
}

/// The molecules of a structure, each ascending, by their first particles.
std::vector<Particles> molecules_of(const ParticleSystem<double>& s) {
  const Topology& topology = *s.topology();
  const std::vector<std::int64_t>& numbers = topology.molecules;
  if (std::all_of(numbers.begin(), numbers.end(), [](std::int64_t number) { return number == 0; })) {
    return bonded_components(topology, s.size());
  }
  std::map<std::int64_t, std::size_t> place;
  std::vector<Particles> list;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] == 0) continue;
    const auto [at, is_new] = place.emplace(numbers[i], list.size());
    if (is_new) list.emplace_back();
    list[at->second].push_back(static_cast<Index>(i));
  }
  return list;
}

Lengths molecule_lengths(const ParticleSystem<double>& s) {
  Lengths known = bond_lengths(*s.topology()), lengths;
  add_ends_of_angles(*s.topology(), known);
  for (const Particles& molecule : molecules_of(s)) {
    for (const auto& [i, j] : rigid_frame(s, molecule)) {
      const auto found = known.find(std::minmax(i, j));
      lengths.emplace(std::minmax(i, j), found == known.end() ? std::nullopt : found->second);
    }
  }
  if (lengths.empty()) {
    throw BadConstraints(
        "there is no molecule of two or more particles, so there is nothing to be held; give a structure with "
        "molecules or bonds");
  }
  return lengths;
}

/// Pairs that the distances of a set hold, by particle.
std::map<Index, std::set<Index>> held_neighbors(const ConstraintSet& set) {
  std::map<Index, std::set<Index>> neighbors;
  for (const auto& group : set.groups()) {
    if (dynamic_cast<const ConstraintsOf<Distance>*>(group.get()) == nullptr) continue;
    for (Index c = 0; c < group->size(); ++c) {
      const Index i = group->particle(c, 0), j = group->particle(c, 1);
      neighbors[i].insert(j);
      neighbors[j].insert(i);
    }
  }
  return neighbors;
}

/// The particles that can be reached from one of them, ascending, and how many distances there are among them.
std::pair<Particles, Index> component_of(Index first, const std::map<Index, std::set<Index>>& neighbors,
                                         std::set<Index>& seen) {
  Particles component = {first};
  seen.insert(first);
  Index ends = 0;
  for (std::size_t k = 0; k < component.size(); ++k) {
    for (const Index j : neighbors.at(component[k])) {
      ++ends;
      if (seen.insert(j).second) component.push_back(j);
    }
  }
  std::sort(component.begin(), component.end());
  return {component, ends / 2};
}

/// Adds every pair that is held, and every three and four particles of which all pairs are.
void add_cliques(Particles& clique, const std::set<Index>& candidates,
                 const std::map<Index, std::set<Index>>& neighbors, std::vector<Particles>& groups) {
  if (clique.size() > 1) groups.push_back(clique);
  if (clique.size() == 4) return;
  for (const Index next : candidates) {
    if (next < clique.back()) continue;
    std::set<Index> common;
    const std::set<Index>& others = neighbors.at(next);
    std::set_intersection(candidates.begin(), candidates.end(), others.begin(), others.end(),
                          std::inserter(common, common.end()));
    clique.push_back(next);
    add_cliques(clique, common, neighbors, groups);
    clique.pop_back();
  }
}

}  // namespace

std::vector<HeldDistance> held_distances(const ParticleSystem<double>& s, RigidTerms what, HeldLengths lengths) {
  const Topology* topology = s.topology();
  if (topology == nullptr || (what != RigidTerms::molecules && topology->bonds.empty())) {
    throw BadConstraints(
        "the particles have no bonds, so there is nothing to be held; give a structure or a builder with bonds, or "
        "name the particles of a constraint 'distance'");
  }
  Lengths held = what == RigidTerms::molecules ? molecule_lengths(s) : bond_lengths(*topology);
  if (what == RigidTerms::hydrogen_bonds) keep_hydrogens(s, held);
  if (what == RigidTerms::bonds_and_angles) add_ends_of_angles(*topology, held);
  if (lengths == HeldLengths::start) {
    for (auto& [pair, length] : held) length.reset();
  }
  return as_list(held);
}

ConstraintSet& add_held(ConstraintSet& set, const ParticleSystem<double>& s,
                        const std::vector<HeldDistance>& distances) {
  for (const HeldDistance& one : distances) set.add(s, Distance{one.length}, one.particles);
  return set;
}

namespace {

ConstraintSet set_of(const ParticleSystem<double>& s, RigidTerms what, const ConstraintOptions& options) {
  ConstraintSet set(options);
  add_held(set, s, held_distances(s, what));
  return set;
}

}  // namespace

ConstraintSet bonds(const ParticleSystem<double>& s, ConstraintOptions options) {
  return set_of(s, RigidTerms::bonds, options);
}
ConstraintSet hydrogen_bonds(const ParticleSystem<double>& s, ConstraintOptions options) {
  return set_of(s, RigidTerms::hydrogen_bonds, options);
}
ConstraintSet bonds_and_angles(const ParticleSystem<double>& s, ConstraintOptions options) {
  return set_of(s, RigidTerms::bonds_and_angles, options);
}
ConstraintSet rigid_molecules(const ParticleSystem<double>& s, ConstraintOptions options) {
  return set_of(s, RigidTerms::molecules, options);
}

std::vector<std::vector<Index>> rigid_groups(const ConstraintSet& set) {
  const std::map<Index, std::set<Index>> neighbors = held_neighbors(set);
  std::vector<Particles> groups;
  std::set<Index> seen;
  for (const auto& [first, others] : neighbors) {
    if (seen.contains(first)) continue;
    const auto [component, distances] = component_of(first, neighbors, seen);
    if (component.size() > 4 && distances >= 3 * std::ssize(component) - 6) {
      groups.push_back(component);
      continue;
    }
    const auto old = static_cast<std::ptrdiff_t>(groups.size());
    for (const Index i : component) {
      Particles clique = {i};
      add_cliques(clique, neighbors.at(i), neighbors, groups);
    }
    // A component that is one of its own cliques says all that its parts would say.
    if (const auto whole = std::find(groups.begin() + old, groups.end(), component); whole != groups.end()) {
      groups.erase(groups.begin() + old, groups.end());
      groups.push_back(component);
    }
  }
  return groups;
}

void leave_out_rigid_terms(ParticleSystem<double>& s, const ConstraintSet& set) {
  if (s.topology() == nullptr) return;
  Topology topology = *s.topology();
  topology.rigid = rigid_groups(set);
  s.set_topology(std::make_shared<const Topology>(std::move(topology)));
}

}  // namespace noether

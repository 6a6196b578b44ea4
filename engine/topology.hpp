#pragma once
/// Who is bonded to whom. Its place is the engine: files read it, forces and constraints use it, and these three rooms
/// do not see each other.

#include "numbers/types.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace noether {

struct Mesh;

/// One bonded term: its particles and the index of its kind.
template <std::size_t n> struct BondedTerm {
  std::array<Index, n> particles{};
  int type = 0;

  bool operator==(const BondedTerm&) const = default;
};

/// A kind of bonded term: the name of its potential, and the parameters in the order in which that potential lists them
/// (forces/bonded.hpp), in the units of the system.
struct TermKind {
  std::string potential;
  std::vector<double> parameters;

  bool operator==(const TermKind&) const = default;
};

/// Lennard-Jones parameters of a type, or of a pair of types.
struct PairKind {
  double epsilon = 0;  ///< [energy]
  double sigma = 0;    ///< [length]

  bool operator==(const PairKind&) const = default;
};

/// How the parameters of two types become those of a pair.
enum class Mixing : std::uint8_t {
  lorentz_berthelot,  ///< epsilon = sqrt(e_i e_j), sigma = (s_i + s_j) / 2
  geometric,          ///< epsilon = sqrt(e_i e_j), sigma = sqrt(s_i s_j)
};

/// The parameters of a pair by a rule. @source Lorentz1881, Berthelot1898
PairKind mix(Mixing rule, const PairKind& a, const PairKind& b);

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
  std::vector<TermKind> bond_kinds, angle_kinds, dihedral_kinds, improper_kinds;  ///< by type of the term
  /// Groups of particles that constraints hold as rigid bodies, a bond among them as a group of two: a bonded term
  /// within one of them is constant, and the force `bonded` leaves it out.
  std::vector<std::vector<Index>> rigid;
  /// The bodies that deform, divided into tetrahedra (engine/mesh.hpp); null where there are none. Copies share it.
  std::shared_ptr<const Mesh> mesh;

  std::vector<PairKind> pair_kinds;  ///< by type of the particle; empty where nothing was said of Lennard-Jones
  Mixing mixing = Mixing::lorentz_berthelot;
  std::map<std::pair<int, int>, PairKind> explicit_pairs;  ///< by types, the smaller first: instead of mixing
  double stated_cutoff = 0;  ///< that a file names beside them [length]; forces have cutoffs of their own; 0: none

  using Pair = std::pair<Index, Index>;  ///< the smaller index first
  std::vector<Pair> exclusions;          ///< pairs without pair force, sorted
  /// A pair whose pair force is scaled.
  struct ScaledPair {
    Pair pair;
    double factor;
    bool operator==(const ScaledPair&) const = default;
  };
  std::vector<ScaledPair> scaled_pairs;  ///< sorted

  /// Whether a dihedral is a pair force between its ends, and nothing else.
  bool acts_on_ends(const BondedTerm<4>& dihedral) const {
    const auto kind = static_cast<std::size_t>(dihedral.type);
    return kind < dihedral_kinds.size() && dihedral_kinds[kind].potential == "one_four";
  }
  /// Whether all dihedrals have kinds. Where one has none, a kind that is added would become its own.
  bool has_dihedral_kinds() const;
  /// Whether the pair force of two particles is excluded or scaled. @cost O(log pairs)
  bool is_special(Index i, Index j) const;
  /// What is left of the pair force of two particles: 0 of an excluded pair, 1 of most. @cost O(log pairs)
  double pair_factor(Index i, Index j) const;
  /// Type of particle `i`; 0 where no types were given.
  int type(Index i) const { return types.empty() ? 0 : static_cast<int>(types[static_cast<std::size_t>(i)]); }
  /// Number of types, 1 at least.
  int type_count() const;
  /// Lennard-Jones parameters of two types: explicit ones, or mixed.
  /// @throws Error  if a type has none
  PairKind pair_kind(int a, int b) const;

  /// Number of bonds on the shortest path between particles up to `most` apart, sorted by pair.
  /// @param n  number of particles; every bond lies in [0, n)
  /// @throws LogicError  if a bond names a particle that is not there
  /// @cost O(n b^most) with b bonds per particle
  struct Separated {
    Pair pair;
    int bonds;
  };
  std::vector<Separated> bond_separations(Index n, int most) const;

  /// Scales pair forces by the number of bonds between the two: factors for pairs one, two and three bonds apart. 0
  /// excludes a pair, 1 leaves it alone. The shortest path counts.
  /// @param n  number of particles
  void scale_by_bonds(Index n, const std::array<double, 3>& factors);
  /// Takes away the pair forces of these pairs too, whatever their bonds have left of them.
  void exclude(const std::vector<Pair>& pairs);

  /// The same without the bonded terms within the groups of `rigid`, and without these groups.
  /// @param n  number of particles; groups lie in [0, n)
  /// @throws LogicError  if a group or a term names a particle that is not there
  /// @cost O(n + terms g) with g groups for each particle
  Topology without_rigid_terms(Index n) const;
};

/// The molecule of each of `n` particles, as the index of its first particle: those of one number, but 0 is none.
std::vector<Index> molecules_by_number(const Topology& topology, Index n);
/// The same: those that bonds hold together.
std::vector<Index> molecules_by_bonds(const Topology& topology, Index n);

}  // namespace noether

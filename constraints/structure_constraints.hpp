#pragma once
/// Constraints that a structure brings: its bonds, the bonds of its hydrogens, its angles, whole molecules.

#include "constraints/constraint_set.hpp"
#include "engine/particle_system.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace noether {

/// What of a structure is rigid.
enum class RigidTerms : std::uint8_t {
  bonds,             ///< every bond
  hydrogen_bonds,    ///< every bond that ends in a hydrogen
  bonds_and_angles,  ///< every bond, and the ends of every angle between two bonds
  molecules,         ///< every molecule, as a rigid body
};

/// Where the lengths of constraints come from.
enum class HeldLengths : std::uint8_t {
  equilibrium,  ///< from the kinds of bonds and angles; as at the start where those have none
  start,        ///< as at the start, all of them
};

template <> struct EnumNames<HeldLengths> {
  static constexpr std::array<std::pair<HeldLengths, std::string_view>, 2> values = {
      {{HeldLengths::equilibrium, "equilibrium"}, {HeldLengths::start, "start"}}};
};

/// Two particles, the smaller index first, and how far apart they stay [length]; empty: as far as they start.
struct HeldDistance {
  std::array<Index, 2> particles{};
  std::optional<double> length = {};

  bool operator==(const HeldDistance&) const = default;
};

/// The distances that make something of the structure of `s` rigid, each pair once.
///
/// **Lengths.** A bond has the length at which its potential is least (`harmonic`, `morse`); the ends of an angle have
/// the distance that two such bonds and the angle of least energy make (`harmonic`, `cosine_squared`, `urey_bradley`).
/// Other kinds have none, and the start counts. Of a molecule, pairs that are neither bonded nor the ends of an angle
/// are held as they start.
///
/// **Hydrogens.** A particle is a hydrogen by its mass: below 1.6 u it is one, from 4.1 u on it is none. Between the
/// two, where repartitioned masses lie, the name of its type tells, or its own where types are numbers: it begins with
/// H behind its digits, as H, HW1, 1HB and hc do, but He, Hf, Hg, Ho and Hs do not. Reduced units have no u, so names
/// alone tell there.
///
/// **Molecules** are those of the topology (numbered from 1: particles of number 0 are free), or without numbers what
/// bonds connect. Two sites take one distance, three take three; of N > 3 four are chosen that span a tetrahedron,
/// and every other one is tied to three of these, 3 N - 6 distances together.
///
/// @throws BadConstraints  where there is nothing to be held; for a particle of which nobody knows whether it is a
///   hydrogen; for a molecule of three sites in line or of more in a plane, which distances do not hold
/// @cost O(n + terms), with logarithms of the terms
/// @source RyckaertCiccottiBerendsen1977, CiccottiFerrarioRyckaert1982
std::vector<HeldDistance> held_distances(const ParticleSystem<double>& s, RigidTerms what,
                                         HeldLengths lengths = HeldLengths::equilibrium);

/// Adds these distances to a set. @throws BadConstraints, Error  as `held_distances`, and as `ConstraintSet::add`
ConstraintSet& add_held(ConstraintSet& set, const ParticleSystem<double>& s,
                        const std::vector<HeldDistance>& distances);

/// The same as sets of their own; `bonded` still has what they hold, unless `leave_out_rigid_terms` is told:
///
///     const ConstraintSet rigid = hydrogen_bonds(peptide);
///     leave_out_rigid_terms(peptide, rigid);
///
/// @throws BadConstraints, Error  as `add_held`
ConstraintSet bonds(const ParticleSystem<double>& s, ConstraintOptions options = {});
ConstraintSet hydrogen_bonds(const ParticleSystem<double>& s, ConstraintOptions options = {});
ConstraintSet bonds_and_angles(const ParticleSystem<double>& s, ConstraintOptions options = {});
ConstraintSet rigid_molecules(const ParticleSystem<double>& s, ConstraintOptions options = {});

/// Groups of particles that the distances of a set hold as rigid bodies, each sorted: every pair that is held, every
/// three and four particles of which all pairs are, and the particles of a component of N > 3 with 3 N - 6 distances
/// or more, which are independent in a set that a run accepts.
/// @cost O(n + distances d^2) with d distances on each particle
std::vector<std::vector<Index>> rigid_groups(const ConstraintSet& set);

/// Takes the bonded terms that a set holds constant out of the force `bonded`: the topology of `s` gets their groups.
/// Bonds in pictures and files, and the pairs that pair forces leave out, stay as they are.
void leave_out_rigid_terms(ParticleSystem<double>& s, const ConstraintSet& set);

}  // namespace noether

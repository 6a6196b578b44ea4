#pragma once
/// The bonded terms of a topology, ready to be evaluated: kinds known by number, and where each particle takes part.

#include "engine/topology.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace noether {

enum class BondPotential : std::uint8_t { harmonic, morse, fene };
enum class AnglePotential : std::uint8_t { harmonic, cosine, cosine_squared, urey_bradley };
enum class DihedralPotential : std::uint8_t { periodic, ryckaert_bellemans, harmonic_improper, one_four };

/// One kind of term: its potential, and the parameters in the order of forces/bonded.hpp.
template <class Potential> struct BondedKind {
  Potential potential{};
  std::array<double, 6> parameters{};
};

/// The kinds of a topology, and for each particle its places among the forces of the terms.
///
/// Every particle of every term has a slot: bonds first, then angles, dihedrals and impropers, in the order of the
/// topology; the two of a bond share one, that of the first, since the other feels the opposite. The force on a
/// particle is the sum of its slots in that order. Terms within a group that constraints hold rigid are not among them.
class BondedTerms {
 public:
  /// @param n  number of particles
  /// @throws Error  for a kind that nobody knows, parameters it does not take, and particles that are not there
  BondedTerms(std::shared_ptr<const Topology> topology, Index n);

  /// The topology with the terms that are evaluated.
  const Topology& topology() const { return *topology_; }
  /// Whether these are the terms of that topology and so many particles.
  bool belong_to(const Topology* topology, Index n) const { return topology == origin_.get() && n == particles(); }

  std::vector<BondedKind<BondPotential>> bonds;
  std::vector<BondedKind<AnglePotential>> angles;
  std::vector<BondedKind<DihedralPotential>> dihedrals, impropers;

  Index particles() const { return static_cast<Index>(first_.size()) - 1; }
  /// Number of terms of the four families together.
  Index terms() const { return terms_; }
  /// Number of slots, of all terms and of one.
  Index slots() const { return slots_; }
  template <std::size_t n> static constexpr Index slots_of(const BondedTerm<n>& /*term*/) {
    return n == 2 ? 1 : static_cast<Index>(n);
  }
  /// Where the forces of a particle stand.
  struct Places {
    const std::uint32_t* first;   ///< those of particle i in `slot` from first[i] to first[i + 1]
    const std::uint32_t* slot;    ///< 2 slot, or 2 slot + 1 where it feels the opposite
    const std::uint8_t* in_step;  ///< so many particles, this one included, have one slot further each
  };
  Places places() const { return {first_.data(), slot_.data(), particles_in_step_.data()}; }
  /// So many bonds, that one included, join one particle further each.
  const std::uint8_t* in_step(Index bond) const { return bonds_in_step_.data() + bond; }

 private:
  std::shared_ptr<const Topology> origin_, topology_;
  Index terms_ = 0, slots_ = 0;
  std::vector<std::uint32_t> first_, slot_;  ///< as `Places` has them
  std::vector<std::uint8_t> particles_in_step_, bonds_in_step_;
};

}  // namespace noether

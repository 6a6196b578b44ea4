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
enum class AnglePotential : std::uint8_t { harmonic, cosine, cosine_squared };
enum class DihedralPotential : std::uint8_t { periodic, ryckaert_bellemans, harmonic_improper };

/// One kind of term: its potential, and the parameters in the order of forces/bonded.hpp.
template <class Potential> struct BondedKind {
  Potential potential{};
  std::array<double, 6> parameters{};
};

/// The kinds of a topology, and for each particle its places among the forces of the terms.
///
/// Every particle of every term has a slot: bonds first, then angles, dihedrals and impropers, in the order of the
/// topology; the two of a bond share one, that of the first, since the other feels the opposite. The force on a
/// particle is the sum of its slots in that order.
class BondedTerms {
 public:
  /// @param n  number of particles
  /// @throws Error  for a kind that nobody knows, parameters it does not take, and particles that are not there
  BondedTerms(std::shared_ptr<const Topology> topology, Index n);

  const Topology& topology() const { return *topology_; }
  /// Whether these are the terms of that topology and so many particles.
  bool belong_to(const Topology* topology, Index n) const { return topology == topology_.get() && n == particles(); }

  std::vector<BondedKind<BondPotential>> bonds;
  std::vector<BondedKind<AnglePotential>> angles;
  std::vector<BondedKind<DihedralPotential>> dihedrals, impropers;

  Index particles() const { return static_cast<Index>(first_.size()) - 1; }
  /// Number of terms of the four families together.
  Index terms() const { return terms_; }
  /// Number of slots, of all terms and of one.
  Index slots() const { return slots_; }
  template <std::size_t n> static constexpr std::size_t slots_of(const BondedTerm<n>& /*term*/) {
    return n == 2 ? 1 : n;
  }
  /// Calls `body(slot, sign)` for the slots of particle `i`, in order; sign is -1 where it feels the opposite, else 1.
  template <class Body> void for_each_slot(Index i, const Body& body) const {
    const auto at = static_cast<std::size_t>(i);
    for (std::size_t k = first_[at]; k < first_[at + 1]; ++k) {
      body(static_cast<std::size_t>(slot_[k] / 2), signs[slot_[k] % 2]);
    }
  }

 private:
  static constexpr double signs[2] = {1, -1};

  std::shared_ptr<const Topology> topology_;
  Index terms_ = 0, slots_ = 0;
  std::vector<std::size_t> first_;   ///< by particle, shape (n + 1)
  std::vector<std::uint32_t> slot_;  ///< those of particle i from first_[i] to first_[i + 1]: 2 slot, or with the
                                     ///< opposite sign 2 slot + 1
};

}  // namespace noether

#pragma once
/// Charges in equal molecules of three, as those of water: neighbors are found, and pairs computed, by molecules.

#include "engine/particle_system.hpp"
#include "forces/pair_groups.hpp"
#include "neighbors/subset_list.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace noether::detail {

/// All charges of a system, where they are those of equal molecules of three that exclude each other's pair forces.
///
/// Of a molecule the list of neighbors knows one particle, its middle. If no other is further from a middle than d,
/// then pairs up to a range R are those of molecules whose middles are up to R + 2 d apart; d is measured in every
/// evaluation, so that nothing need be rigid. Middles are fewer and slower than all particles, and three sites of a
/// neighbor are looked up at once. All positions are differences on the grid of the box, so forces have the bits of
/// pairs that are found one by one.
/// @cost O(n); 96 bytes for each molecule and image, in mixed precision 48
class ChargedMolecules {
 public:
  static constexpr std::size_t sites = 3;

  /// Brings the list up to date. False where charges are not in such molecules, or the box is so small that a molecule
  /// would meet itself.
  bool update(const ParticleSystem<double>& s, double range, NeighborList* shared);

  ListedPairs pairs() const;
  /// Of the sites of each record of the list, shape (records, 3, 4): x, y, z [length], and a number that means nothing.
  /// Laid out anew.
  const double* records();
  /// The same in whole numbers of a spacing, whose differences are right modulo 2^32.
  const std::int32_t* whole_records(const ParticleSystem<double>& s);
  /// A power of two, of the box alone [length].
  static double whole_spacing(const Box& box);
  double charge(std::size_t site) const { return charges_[site]; }

 private:
  bool find(const ParticleSystem<double>& s);
  bool are_known(const ParticleSystem<double>& s) const;
  double measure(const ParticleSystem<double>& s);

  std::array<std::vector<std::int32_t>, sites> particles_;  ///< of each molecule, the middle first
  std::array<double, sites> charges_{};
  std::uint64_t members_ = 0;
  std::shared_ptr<const Topology> topology_;
  SubsetList middles_;
  double range_ = 0;                                                     ///< of the list [length]
  std::array<std::array<AlignedVector<double>, 3>, sites - 1> offsets_;  ///< of the others from the middle, by axis
  AlignedVector<double> records_;
  AlignedVector<std::int32_t> whole_sites_, whole_records_;  ///< by molecule, and by record
};

}  // namespace noether::detail

#pragma once
/// Of a system some particles alone, and who is near whom among them.

#include "neighbors/neighbor_list.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace noether {

/// A neighbor list of some particles of a system, which it knows by their places among these: with a range, a skin and
/// searches of its own. Where few particles act, and slowly move, as the oxygens of water, which are a third, that is
/// less work than to take their pairs out of the list of all.
/// @cost O(members) for a search and for an update
class SubsetList {
 public:
  /// Whom the list is for. Cheap where nobody has come, gone, or changed.
  /// @param acts  by type: 1 for those that belong to it
  void choose(const ParticleSystem<double>& s, const std::vector<std::uint8_t>& acts);
  /// The same by their indices; their types are not asked for, nor what is excluded among them.
  void choose(const ParticleSystem<double>& s, std::vector<std::int32_t> members);

  Index size() const { return static_cast<Index>(members_.size()); }
  /// Of a particle of the list its index in the system.
  const std::int32_t* members() const { return members_.data(); }

  /// Takes the positions of the members, as NeighborList::update. Another range makes a new list.
  /// @param shared  the list of all, whose options it has, and which counts what it does; null: there is none
  void update(const ParticleSystem<double>& s, double range, NeighborList* shared,
              NeighborList::Numbers numbers = NeighborList::Numbers::doubles);
  const NeighborList& list() const { return list_; }

 private:
  void take_members(const ParticleSystem<double>& s, std::shared_ptr<const Topology> topology);

  std::vector<std::uint8_t> acts_;
  std::vector<std::int32_t> members_;
  ParticleSystem<double> part_;
  NeighborList list_;
  std::uint64_t chosen_from_ = 0, version_ = 0;  ///< members and positions of the system
  std::shared_ptr<const Topology> topology_;     ///< of the system
};

}  // namespace noether

#pragma once
/// Of a neighbor list the pairs of some types alone.

#include "neighbors/neighbor_list.hpp"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace noether {

/// Of a neighbor list those particles and entries alone whose types act on each other: where only the oxygens of water
/// have a Lennard-Jones force, a ninth of the pairs. Particles that act follow each other in groups of their own, so
/// that lanes are full; entries keep their order, and shells hold what they held.
/// @cost O(entries) after a search; the memory of the entries that are kept
class NeighborSelection {
 public:
  /// Takes entries from a list where it has searched since, or where other types act.
  /// @param types  how many there are @param acts  (a, b): whether type a acts on type b, as b on a
  template <class Acts> void update(const NeighborList& list, int types, const Acts& acts) {
    bool known = edition_ == list.edition() && types_ == types;
    types_ = types;
    acts_.resize(static_cast<std::size_t>(types) * static_cast<std::size_t>(types));
    std::size_t k = 0;
    for (int a = 0; a < types; ++a) {
      for (int b = 0; b < types; ++b, ++k) {
        const std::uint8_t before = std::exchange(acts_[k], acts(a, b) ? 1 : 0);
        known = known && before == acts_[k];
      }
    }
    if (!known) take(list);
  }
  Index groups() const { return static_cast<Index>(rows_.size()); }
  /// Eight particles that act, of the list that they were taken from, as `NeighborList::group`.
  NeighborList::Group group(const NeighborList& list, Index g) const;

 private:
  struct Rows {
    std::int64_t begin = 0;
    std::array<std::int32_t, NeighborList::shells> rows{};
  };

  void take(const NeighborList& list);
  void form_groups(const NeighborList& list);
  template <class Visit> void for_entries(const NeighborList& list, Index place, const Visit& visit) const;
  Rows count(const NeighborList& list, Index g) const;
  void take(const NeighborList& list, Index g);

  std::uint64_t edition_ = 0;
  int types_ = 0;
  std::vector<std::uint8_t> acts_;               ///< shape (types, types)
  std::vector<std::int32_t> particles_, lanes_;  ///< as those of the list
  std::vector<Index> places_;                    ///< of a lane: group and lane of the list; -1: nobody
  std::vector<Rows> rows_;
  AlignedVector<std::int32_t> entries_;
};

}  // namespace noether

#include "neighbors/neighbor_selection.hpp"

#include <algorithm>
#include <bit>

namespace noether {

namespace {

constexpr Index size = NeighborList::group_size;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

std::int64_t type_of(const NeighborList& list, std::int32_t record_begin) {
  return std::bit_cast<std::int64_t>(list.records()[record_begin + 3]);
}

std::int32_t nobody_of(const NeighborList& list) {
  return static_cast<std::int32_t>(4 * list.particles_of_records().size());
}

/// Rows that kernels may look at, which take several at once.
Index room_of(Index rows) { return (rows + size - 1) / size * size; }

}  // namespace

/// A particle of a group: whether it acts at all, and on a neighbor.
class NeighborSelection::Own {
 public:
  Own(const NeighborSelection& selection, const NeighborList& list, const NeighborList::Group& group, Index lane)
      : list_(list), nobody_(nobody_of(list)) {
    if (group.particles[lane] < 0) return;
    const std::uint8_t* const row = selection.acts_.data() + type_of(list, group.records[lane]) * selection.types_;
    if (std::find(row, row + selection.types_, 1) != row + selection.types_) acts_ = row;
  }
  bool acts() const { return acts_ != nullptr; }
  bool acts_on(std::int32_t entry) const { return entry != nobody_ && acts_[type_of(list_, entry)] != 0; }

 private:
  const NeighborList& list_;
  std::int32_t nobody_;
  const std::uint8_t* acts_ = nullptr;  ///< on each type
};

NeighborSelection::Rows NeighborSelection::count(const NeighborList& list, Index g) const {
  const NeighborList::Group group = list.group(g);
  Rows found;
  for (Index lane = 0; lane < size; ++lane) {
    const Own own(*this, list, group, lane);
    std::int32_t kept = 0;
    Index row = 0;
    for (int shell = 0; shell < NeighborList::shells && own.acts(); ++shell) {
      for (; row < list.rows(g, shell); ++row) kept += own.acts_on(group.entries[size * row + lane]) ? 1 : 0;
      std::int32_t& most = found.rows[at(shell)];
      most = std::max(most, kept);
    }
  }
  return found;
}

void NeighborSelection::take(const NeighborList& list, Index g) {
  const NeighborList::Group group = list.group(g);
  const Index all = list.rows(g, NeighborList::shells - 1);
  std::int32_t* const entries = entries_.data() + rows_[at(g)].begin;
  std::fill_n(entries, size * room_of(rows_[at(g)].rows.back()), nobody_of(list));
  for (Index lane = 0; lane < size; ++lane) {
    const Own own(*this, list, group, lane);
    std::int32_t* to = entries + lane;
    for (Index row = 0; row < all && own.acts(); ++row) {
      const std::int32_t entry = group.entries[size * row + lane];
      if (!own.acts_on(entry)) continue;
      *to = entry;
      to += size;
    }
  }
}

void NeighborSelection::take(const NeighborList& list) {
  rows_.resize(at(list.groups()));
  const auto for_groups = [&](const auto& body) {
    for_blocks(size * list.groups(), [&](Index begin, Index end) {
      for (Index g = begin / size; g < end / size; ++g) body(g);
    });
  };
  for_groups([&](Index g) { rows_[at(g)] = count(list, g); });
  std::int64_t total = 0;
  for (Rows& rows : rows_) {
    rows.begin = total;
    total += size * room_of(rows.rows.back());
  }
  entries_.resize(at(total));
  for_groups([&](Index g) { take(list, g); });
  edition_ = list.edition();
}

NeighborList::Group NeighborSelection::group(const NeighborList& list, Index g) const {
  NeighborList::Group group = list.group(g);
  const Rows& own = rows_[at(g)];
  group.entries = entries_.data() + own.begin;
  group.rows = own.rows[at(list.shell())];
  return group;
}

}  // namespace noether

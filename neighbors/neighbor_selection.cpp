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

void NeighborSelection::form_groups(const NeighborList& list) {
  particles_.clear();
  lanes_.clear();
  places_.clear();
  const auto add = [&](std::int32_t particle, std::int32_t record, Index place) {
    particles_.push_back(particle);
    lanes_.push_back(record);
    places_.push_back(place);
  };
  for (Index g = 0; g < list.groups(); ++g) {
    const NeighborList::Group group = list.group(g);
    for (Index lane = 0; lane < size; ++lane) {
      if (group.particles[lane] < 0) continue;
      const std::uint8_t* const row = acts_.data() + type_of(list, group.records[lane]) * types_;
      if (std::find(row, row + types_, 1) != row + types_)
        add(group.particles[lane], group.records[lane], size * g + lane);
    }
  }
  // A lane without a particle stands where another one does, and has no neighbors.
  while (particles_.size() % size != 0) add(-1, lanes_.back(), -1);
  rows_.resize(particles_.size() / size);
}

/// Calls `visit(entry, shell)` for the neighbors of a particle of the list on which it acts.
template <class Visit>
void NeighborSelection::for_entries(const NeighborList& list, Index place, const Visit& visit) const {
  if (place < 0) return;
  const std::int32_t nobody = nobody_of(list);
  const NeighborList::Group group = list.group(place / size);
  const Index lane = place % size;
  const std::uint8_t* const acts = acts_.data() + type_of(list, group.records[lane]) * types_;
  Index row = 0;
  for (int shell = 0; shell < NeighborList::shells; ++shell) {
    for (; row < list.rows(place / size, shell); ++row) {
      const std::int32_t entry = group.entries[size * row + lane];
      if (entry != nobody && acts[type_of(list, entry)] != 0) visit(entry, shell);
    }
  }
}

NeighborSelection::Rows NeighborSelection::count(const NeighborList& list, Index g) const {
  Rows found;
  for (Index lane = 0; lane < size; ++lane) {
    std::array<std::int32_t, NeighborList::shells> kept{};
    for_entries(list, places_[at(size * g + lane)], [&](std::int32_t, int shell) { ++kept[at(shell)]; });
    std::int32_t within = 0;
    for (std::size_t shell = 0; shell < kept.size(); ++shell) {
      within += kept[shell];
      found.rows[shell] = std::max(found.rows[shell], within);
    }
  }
  return found;
}

void NeighborSelection::take(const NeighborList& list, Index g) {
  std::int32_t* const entries = entries_.data() + rows_[at(g)].begin;
  std::fill_n(entries, size * room_of(rows_[at(g)].rows.back()), nobody_of(list));
  for (Index lane = 0; lane < size; ++lane) {
    std::int32_t* to = entries + lane;
    for_entries(list, places_[at(size * g + lane)], [&](std::int32_t entry, int) {
      *to = entry;
      to += size;
    });
  }
}

void NeighborSelection::take(const NeighborList& list) {
  form_groups(list);
  const auto for_groups = [&](const auto& body) {
    for_blocks(size * groups(), [&](Index begin, Index end) {
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
  const Rows& own = rows_[at(g)];
  return {particles_.data() + size * g, lanes_.data() + size * g, entries_.data() + own.begin,
          own.rows[at(list.shell())]};
}

}  // namespace noether

#include "neighbors/subset_list.hpp"

#include <utility>

namespace noether {

namespace {

/// Types and exclusions of some particles of a system. @param members  their indices, rising
std::shared_ptr<const Topology> topology_of(const Topology& all, const std::vector<std::int32_t>& members, Index n) {
  auto part = std::make_shared<Topology>();
  std::vector<Index> place(static_cast<std::size_t>(n), -1);
  for (std::size_t k = 0; k < members.size(); ++k) {
    const auto i = static_cast<std::size_t>(members[k]);
    place[i] = static_cast<Index>(k);
    part->types.push_back(all.type(members[k]));
  }
  part->type_names = all.type_names;
  const auto placed = [&](const Topology::Pair& pair) {
    return Topology::Pair(place[static_cast<std::size_t>(pair.first)], place[static_cast<std::size_t>(pair.second)]);
  };
  for (const Topology::Pair& pair : all.exclusions) {
    const Topology::Pair own = placed(pair);
    if (own.first >= 0 && own.second >= 0) part->exclusions.push_back(own);
  }
  for (const Topology::ScaledPair& scaled : all.scaled_pairs) {
    const Topology::Pair own = placed(scaled.pair);
    if (own.first >= 0 && own.second >= 0) part->scaled_pairs.push_back({own, scaled.factor});
  }
  return part;
}

}  // namespace

void NeighborList::count(const NeighborStatistics& before, const NeighborStatistics& now, double part) {
  statistics_.updates += now.updates - before.updates;
  statistics_.searches += now.searches - before.searches;
  statistics_.sorts += now.sorts - before.sorts;
  statistics_.search_seconds += now.search_seconds - before.search_seconds;
  statistics_.sort_seconds += now.sort_seconds - before.sort_seconds;
  statistics_.bytes += now.bytes - before.bytes;
  if (edition_ != 0) return;
  statistics_.pairs += part * (now.pairs - before.pairs);
  statistics_.skin = now.skin;
}

void SubsetList::choose(const ParticleSystem<double>& s, const std::vector<std::uint8_t>& acts) {
  if (chosen_from_ == s.members() && topology_ == s.shared_topology() && acts_ == acts) return;
  acts_ = acts;
  members_.clear();
  for (Index i = 0; i < s.size(); ++i) {
    const int type = s.topology() != nullptr ? s.topology()->type(i) : 0;
    if (acts_[static_cast<std::size_t>(type)] != 0) members_.push_back(static_cast<std::int32_t>(i));
  }
  take_members(s, s.topology() != nullptr ? topology_of(*s.topology(), members_, s.size()) : nullptr);
}

void SubsetList::choose(const ParticleSystem<double>& s, std::vector<std::int32_t> members) {
  acts_.clear();
  members_ = std::move(members);
  take_members(s, nullptr);
}

void SubsetList::take_members(const ParticleSystem<double>& s, std::shared_ptr<const Topology> topology) {
  chosen_from_ = s.members();
  topology_ = s.shared_topology();
  version_ = 0;
  part_ = ParticleSystem<double>(s.units());
  const Vec3<double> rest = Vec3<double>::Zero();
  std::vector<std::int64_t> ids;
  for (const std::int32_t i : members_) {
    part_.add(s.name(i), 1, s.positions()[i], rest);
    ids.push_back(s.ids()[static_cast<std::size_t>(i)]);
  }
  part_.restore_ids(ids);
  part_.set_topology(std::move(topology));
}

void SubsetList::update(const ParticleSystem<double>& s, double range, NeighborList* shared,
                        NeighborList::Numbers numbers) {
  if (range != list_.range()) list_ = NeighborList(range, shared != nullptr ? shared->options() : NeighborOptions{});
  if (version_ != s.version() || !(part_.box() == s.box())) {
    version_ = s.version();
    if (!(part_.box() == s.box())) part_.set_box(s.box());
    VectorColumn<double>& to = part_.positions();
    for_blocks(size(), [&](Index begin, Index end) {
      for (int k = 0; k < 3; ++k) {
        const double* x = s.positions().component(k);
        for (Index i = begin; i < end; ++i) to.component(k)[i] = x[members_[static_cast<std::size_t>(i)]];
      }
    });
  }
  const NeighborStatistics before = list_.statistics();
  list_.update(part_, numbers);
  if (shared != nullptr)
    shared->count(before, list_.statistics(), static_cast<double>(size()) / static_cast<double>(s.size()));
}

}  // namespace noether

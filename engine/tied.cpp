#include "engine/tied.hpp"

#include <fmt/format.h>

#include <unordered_map>

namespace noether::detail {

void find_tied(const std::vector<std::int64_t>& ids, std::vector<Index>& places, std::vector<std::int64_t>& known) {
  const bool first = known.empty();
  std::unordered_map<std::int64_t, Index> now;  // where each id stands; made when the first one has moved
  for (std::size_t k = 0; k < places.size(); ++k) {
    Index& place = places[k];
    const bool there = place >= 0 && place < std::ssize(ids);
    if (first && !there) {
      throw Error(fmt::format("particle {} is tied, but there are only {} particles, counted from 0; give one of them",
                              place, ids.size()));
    }
    if (first) known.push_back(ids[static_cast<std::size_t>(place)]);
    if (there && ids[static_cast<std::size_t>(place)] == known[k]) continue;
    for (std::size_t i = now.size(); i < ids.size(); ++i) now.emplace(ids[i], static_cast<Index>(i));
    const auto found = now.find(known[k]);
    if (found == now.end()) {
      throw Error(fmt::format(
          "the particle with id {} is tied to others or to a place, but has been taken out; keep it", known[k]));
    }
    place = found->second;
  }
}

}  // namespace noether::detail

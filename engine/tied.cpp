#include "engine/tied.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace noether::detail {

void find_tied(const std::vector<std::int64_t>& ids, std::vector<Index>& places, std::vector<std::int64_t>& known) {
  const bool first = known.empty();
  for (std::size_t k = 0; k < places.size(); ++k) {
    Index& place = places[k];
    const bool there = place >= 0 && place < std::ssize(ids);
    if (first && !there) {
      throw Error(
          fmt::format("particle {} is tied, but there are {}, counted from 0; give one of them", place, ids.size()));
    }
    if (first) known.push_back(ids[static_cast<std::size_t>(place)]);
    if (there && ids[static_cast<std::size_t>(place)] == known[k]) continue;
    const auto found = std::find(ids.begin(), ids.end(), known[k]);
    if (found == ids.end()) {
      throw Error(fmt::format(
          "the particle with id {} is tied to others or to a place, but has been taken out; keep it", known[k]));
    }
    place = found - ids.begin();
  }
}

}  // namespace noether::detail

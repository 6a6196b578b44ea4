#include "scene/references.hpp"

#include <cstddef>

namespace noether {

std::string bibtex(std::string_view key) {
  const std::string_view all = references_bib();
  for (std::size_t at = all.find('@'); at != std::string_view::npos; at = all.find('@', at + 1)) {
    const std::size_t open = all.find('{', at);
    if (open == std::string_view::npos) break;
    const std::size_t comma = all.find(',', open);
    if (comma == std::string_view::npos || all.substr(open + 1, comma - open - 1) != key) continue;
    std::size_t depth = 0;
    for (std::size_t end = open; end < all.size(); ++end) {
      if (all[end] == '{') ++depth;
      if (all[end] == '}' && --depth == 0) return std::string(all.substr(at, end + 1 - at));
    }
  }
  return "";
}

}  // namespace noether

#include "scene/references.hpp"

#include <cctype>
#include <cstddef>

namespace noether {

namespace {

/// The key of an entry "@type{key," that begins here; empty if none does.
std::string_view key_at(std::string_view text) {
  std::size_t open = 1;
  while (open < text.size() && std::isalpha(static_cast<unsigned char>(text[open])) != 0) ++open;
  if (open == 1 || open == text.size() || text[open] != '{') return "";
  const std::size_t end = text.find_first_of(",\n}", open);
  return end == std::string_view::npos || text[end] != ',' ? "" : text.substr(open + 1, end - open - 1);
}

}  // namespace

std::string bibtex(std::string_view key) {
  const std::string_view all = references_bib();
  for (std::size_t at = all.find('@'); at != std::string_view::npos; at = all.find('@', at + 1)) {
    const bool line_start = at == 0 || all[at - 1] == '\n';
    if (!line_start || key.empty() || key_at(all.substr(at)) != key) continue;
    std::size_t depth = 0;
    for (std::size_t end = at; end < all.size(); ++end) {
      if (all[end] == '{') ++depth;
      if (all[end] == '}' && --depth == 0) return std::string(all.substr(at, end + 1 - at));
    }
  }
  return "";
}

}  // namespace noether

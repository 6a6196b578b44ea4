#include "integrators/all_schemes.hpp"

#include "numbers/text.hpp"

#include <algorithm>

namespace noether::schemes {

std::span<const Scheme* const> all() {
  static const std::vector<const Scheme*> list = [] {
    std::vector<const Scheme*> every;
    const auto append = [&](const auto& family) {
      for (const Scheme* scheme : family) every.push_back(scheme);
    };
    append(classical_list);
    append(symmetric_4_6_list);
    append(symmetric_8_10_list);
    append(splitting_list);
    append(nystrom_list);
    append(near_integrable_list);
    return every;
  }();
  return list;
}

std::vector<std::string> aliases_of(const Scheme& scheme) { return words_of(scheme.aliases); }

const Scheme* find(std::string_view name) {
  for (const Scheme* scheme : all()) {
    if (scheme->name == name) return scheme;
    const auto aliases = aliases_of(*scheme);
    if (std::find(aliases.begin(), aliases.end(), name) != aliases.end()) return scheme;
  }
  return nullptr;
}

std::vector<std::string> names() {
  std::vector<std::string> every;
  for (const Scheme* scheme : all()) every.emplace_back(scheme->name);
  return every;
}

}  // namespace noether::schemes

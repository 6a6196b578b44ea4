#include "constraints/bond_path.hpp"

#include <cstddef>

namespace noether {

std::optional<BondPath> bond_path(std::span<const std::pair<int, int>> pairs,
                                  const std::vector<double>& inverse_masses) {
  const auto at = [](int k) { return static_cast<std::size_t>(k); };
  if (pairs.size() + 1 != inverse_masses.size()) return {};  // a ring
  std::vector<std::vector<int>> bonds(inverse_masses.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    for (const int atom : {pairs[p].first, pairs[p].second}) bonds[at(atom)].push_back(static_cast<int>(p));
  }
  int end = 0;
  for (int a = static_cast<int>(bonds.size()); a-- > 0;) {
    if (bonds[at(a)].size() > 2) return {};
    if (bonds[at(a)].size() == 1) end = a;
  }
  BondPath path{{end}, {}, {inverse_masses[at(end)]}};
  while (path.bonds.size() < pairs.size()) {
    const int here = path.atoms.back();
    const std::vector<int>& both = bonds[at(here)];
    const int next = !path.bonds.empty() && both.front() == path.bonds.back() ? both.back() : both.front();
    const auto [a, b] = pairs[at(next)];
    path.bonds.push_back(next);
    path.atoms.push_back(a == here ? b : a);
    path.inverse_masses.push_back(inverse_masses[at(path.atoms.back())]);
  }
  return path;
}

}  // namespace noether

#include "constraints/bond_tree.hpp"

namespace noether {

std::vector<TreeCenter> tree_centers(const EliminationLists& lists) {
  if (lists.constraints + 1 != lists.atoms) return {};
  std::vector<TreeCenter> centers;
  int entry = 0;
  for (int at = 0; at < lists.centers; ++at) {
    const EliminationCenter& c = lists.center[at];
    const int leaves = c.leaves_end - c.first, inner = c.end - c.leaves_end, outs = c.out_end - c.out_begin;
    if (leaves + inner + outs > 4 || inner > 3) return {};
    const auto center_of = [&](int constraint) { return lists.center_of[lists.i[constraint]]; };
    const int out = outs > 0 ? lists.outgoing[c.out_begin] : 0;
    const TreeShape shape{leaves, inner, outs > 0, outs > 0 && out == lists.center[at + 1].end - 1};
    if (!shape.exists() || (inner > 0 && center_of(c.end - 1) != at - 1)) return {};
    TreeCenter center{at, shape.code(), c.first, out, entry, {0, 0}, c.inverse_mass};
    for (int q = 0; q + 1 < inner; ++q) center.before[q] = center_of(c.leaves_end + q);
    centers.push_back(center);
    const int own = leaves + inner;
    entry += own * (own + 1) / 2 + (outs > 0 ? own : 0);
  }
  return centers;
}

}  // namespace noether

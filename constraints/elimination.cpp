#include "constraints/elimination.hpp"

#include <algorithm>
#include <map>

namespace noether {

namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }
template <class T> int count(const std::vector<T>& list) { return static_cast<int>(list.size()); }

/// Atoms by their distance from one of them.
std::vector<int> by_distance(const std::vector<std::set<int>>& graph, int from) {
  std::vector<int> queue{from};
  std::vector<bool> seen(graph.size(), false);
  seen[at(from)] = true;
  for (std::size_t q = 0; q < queue.size(); ++q) {
    for (const int b : graph[at(queue[q])]) {
      if (!seen[at(b)]) queue.push_back(b);
      seen[at(b)] = true;
    }
  }
  return queue;
}

}  // namespace

Elimination::Elimination(std::span<const Pair> pairs, std::vector<double> inverse_masses)
    : inverse_mass_(std::move(inverse_masses)) {
  const std::size_t atoms = inverse_mass_.size();
  Graph neighbors(atoms), centers(atoms);
  for (const auto& [a, b] : pairs) neighbors[at(a)].insert(b), neighbors[at(b)].insert(a);
  const auto is_center = [&](int a) {  // of a single bond its first atom
    const std::set<int>& others = neighbors[at(a)];
    return others.size() > 1 ||
           (others.size() == 1 && neighbors[at(*others.begin())].size() == 1 && a < *others.begin());
  };
  std::size_t links = 0, found = 0;
  int any = -1;
  for (int a = 0; a < count(inverse_mass_); ++a) {
    if (!is_center(a)) continue;
    any = a;
    ++found;
    for (const int b : neighbors[at(a)]) {
      if (is_center(b)) centers[at(a)].insert(b), ++links;
    }
  }
  std::vector<int> order = links / 2 + 1 == found ? order_of_tree(centers, any) : order_of_rings(centers);
  if (links == 0) order = {any};
  own_constraints(pairs, order);
  find_entries();
}

/// From the outside to one end of a longest path, each branch to its end before the next, the longest one last: most
/// centers follow one that hangs on them.
std::vector<int> Elimination::order_of_tree(const Graph& centers, int any) {
  const int root = by_distance(centers, any).back();
  const std::vector<int> outward = by_distance(centers, root);
  std::vector<int> parent(centers.size(), -1), depth(centers.size(), 0), order;
  for (const int a : outward) {
    for (const int b : centers[at(a)]) {
      if (b != parent[at(a)]) parent[at(b)] = a;
    }
  }
  for (std::size_t k = outward.size(); k-- > 1;) {
    int& above = depth[at(parent[at(outward[k])])];
    above = std::max(above, depth[at(outward[k])] + 1);
  }
  std::vector<int> open{root};  // the reverse of the order is a walk that takes the longest branch first
  while (!open.empty()) {
    const int a = open.back();
    open.pop_back();
    order.push_back(a);
    std::vector<std::pair<int, int>> branches;
    for (const int b : centers[at(a)]) {
      if (b != parent[at(a)]) branches.emplace_back(depth[at(b)], b);
    }
    std::sort(branches.begin(), branches.end());
    for (const auto& branch : branches) open.push_back(branch.second);
  }
  std::reverse(order.begin(), order.end());
  return order;
}

/// Those with fewest neighbors first, whose neighbors then hang together.
std::vector<int> Elimination::order_of_rings(Graph centers) {
  std::set<std::pair<std::size_t, int>> left;
  for (int a = 0; a < count(centers); ++a) {
    if (!centers[at(a)].empty()) left.emplace(centers[at(a)].size(), a);
  }
  std::vector<int> order;
  while (!left.empty()) {
    const int a = left.begin()->second;
    left.erase(left.begin());
    order.push_back(a);
    const std::set<int> around = centers[at(a)];
    for (const int b : around) {
      left.erase({centers[at(b)].size(), b});
      centers[at(b)].erase(a);
      for (const int c : around) {
        if (c != b) centers[at(b)].insert(c);
      }
    }
    for (const int b : around) left.emplace(centers[at(b)].size(), b);
  }
  return order;
}

void Elimination::own_constraints(std::span<const Pair> pairs, const std::vector<int>& order) {
  center_of_.assign(inverse_mass_.size(), -1);
  for (int c = 0; c < count(order); ++c) center_of_[at(order[at(c)])] = c;
  const auto when = [&](int atom) { return center_of_[at(atom)]; };  // leaves before all centers
  std::vector<int> sorted(pairs.size());
  for (int p = 0; p < count(sorted); ++p) sorted[at(p)] = p;
  const auto first = [&](int p) { return std::min(when(pairs[at(p)].first), when(pairs[at(p)].second)); };
  std::stable_sort(sorted.begin(), sorted.end(), [&](int a, int b) { return first(a) < first(b); });
  std::vector<std::vector<int>> owned(order.size());
  for (const int p : sorted) owned[at(std::max(when(pairs[at(p)].first), when(pairs[at(p)].second)))].push_back(p);
  for (int c = 0; c < count(order); ++c) {
    EliminationCenter center{order[at(c)], count(i_), 0, 0, 0, 0, inverse_mass_[at(order[at(c)])]};
    center.leaves_end = center.first;
    for (const int p : owned[at(c)]) {
      const auto [a, b] = pairs[at(p)];
      const int other = a == center.atom ? b : a;
      i_.push_back(other);
      j_.push_back(center.atom);
      place_.push_back(p);
      inverse_mass_i_.push_back(inverse_mass_[at(other)]);
      inverse_mass_j_.push_back(center.inverse_mass);
      if (when(other) < 0) center.leaves_end = count(i_);
    }
    center.end = count(i_);
    center_.push_back(center);
  }
  given_.resize(place_.size());
  for (int k = 0; k < count(place_); ++k) given_[at(place_[at(k)])] = k;
  for (EliminationCenter& center : center_) {
    center.out_begin = count(outgoing_);
    for (int k = 0; k < count(i_); ++k) {
      if (i_[at(k)] == center.atom) outgoing_.push_back(k);
    }
    center.out_end = count(outgoing_);
  }
}

/// Of r_k . r_l in the matrix: the inverse mass of the atom that they share, with a sign; 0 if they share none.
double Elimination::coupling_of(int k, int l) const {
  const int ik = i_[at(k)], jk = j_[at(k)], il = i_[at(l)], jl = j_[at(l)];
  if (ik == il || jk == jl) return inverse_mass_[at(ik == il ? ik : jk)];
  if (ik == jl || jk == il) return -inverse_mass_[at(ik == jl ? ik : jk)];
  return 0;
}

void Elimination::find_entries() {
  const int n = count(i_);
  std::vector<std::set<int>> rows(at(n)), columns(at(n));
  for (int k = 0; k < n; ++k) {
    for (int l = 0; l < k; ++l) {
      if (coupling_of(k, l) != 0) rows[at(k)].insert(l), columns[at(l)].insert(k);
    }
  }
  for (int m = 0; m < n; ++m) {
    const std::set<int> later = columns[at(m)];
    for (const int a : later) {
      for (const int b : later) {
        if (b < a) rows[at(a)].insert(b), columns[at(b)].insert(a);
      }
    }
  }
  std::map<Pair, int> entry;
  row_ = product_ = below_ = {0};
  for (int k = 0; k < n; ++k) {
    for (const int l : rows[at(k)]) {
      entry[{k, l}] = count(column_);
      column_.push_back(l);
      coupling_.push_back(coupling_of(k, l));
      if (coupling_.back() == 0) ++fill_;
      for (const int m : rows[at(l)]) {
        if (rows[at(k)].count(m) == 0) continue;
        product_left_.push_back(entry[{k, m}] - row_[at(k)]);
        product_right_.push_back(entry[{l, m}]);
      }
      product_.push_back(count(product_left_));
    }
    row_.push_back(count(column_));
    longest_row_ = std::max(longest_row_, row_[at(k + 1)] - row_[at(k)]);
  }
  for (int m = 0; m < n; ++m) {
    for (const int k : columns[at(m)]) below_row_.push_back(k), below_entry_.push_back(entry[{k, m}]);
    below_.push_back(count(below_row_));
  }
}

EliminationLists Elimination::lists() const {
  return {.atoms = count(inverse_mass_),
          .constraints = count(i_),
          .entries = count(column_),
          .centers = count(center_),
          .longest_row = longest_row_,
          .center = center_.data(),
          .given = given_.data(),
          .i = i_.data(),
          .j = j_.data(),
          .inverse_mass = inverse_mass_.data(),
          .inverse_mass_i = inverse_mass_i_.data(),
          .inverse_mass_j = inverse_mass_j_.data(),
          .outgoing = outgoing_.data(),
          .center_of = center_of_.data(),
          .row = row_.data(),
          .column = column_.data(),
          .coupling = coupling_.data(),
          .product = product_.data(),
          .product_left = product_left_.data(),
          .product_right = product_right_.data(),
          .below = below_.data(),
          .below_row = below_row_.data(),
          .below_entry = below_entry_.data()};
}

}  // namespace noether

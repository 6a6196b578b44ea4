#pragma once
/// Rooted trees and the order conditions of Runge-Kutta and Rosenbrock methods.

#include "numbers/real.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace noether::test {

/// A rooted tree: its branches are trees with fewer nodes, by their numbers in the list of all trees.
struct RootedTree {
  std::vector<std::size_t> branches;
  int order = 1;     ///< number of nodes
  long density = 1;  ///< gamma: order times the densities of the branches
};

namespace detail {
/// Adds all trees of `order` nodes whose further branches have `left` nodes together and numbers up to `last`.
inline void grow(std::vector<RootedTree>& trees, int order, int left, std::size_t last,
                 std::vector<std::size_t>& branches) {
  if (left == 0) {
    long density = order;
    for (const std::size_t branch : branches) density *= trees[branch].density;
    trees.push_back({branches, order, density});
    return;
  }
  for (std::size_t k = 0; k <= last; ++k) {
    if (trees[k].order > left) break;
    branches.push_back(k);
    grow(trees, order, left - trees[k].order, k, branches);
    branches.pop_back();
  }
}
}  // namespace detail

/// All rooted trees of up to `most` nodes, by number of nodes: 1, 1, 2, 4, 9, 20, 48, 115, 286, ...
/// @source HairerNoersettWanner1993, II.2
inline std::vector<RootedTree> rooted_trees(int most) {
  std::vector<RootedTree> trees{{}};
  for (int order = 2; order <= most; ++order) {
    std::vector<std::size_t> branches;
    detail::grow(trees, order, order - 1, trees.size() - 1, branches);
  }
  return trees;
}

/// How much a Rosenbrock method violates the conditions of each order: [p] is the worst of order p, from 1 to that of
/// the last tree.
///
///     sum_i b_i phi_i(tree) = theta^nodes / density
///     phi_i(tree) = sum_j beta_ij phi_j(branch) where there is one branch, else prod over them of sum_j alpha_ij phi_j
///
/// beta = alpha + gamma with its diagonal: in k = h f(y0 + alpha k) + h J gamma k the Jacobian matrix joins where f is
/// differentiated once, and nowhere else.
/// @param alpha, beta  shape (s, s) or shorter rows: what is missing is 0
/// @param theta  where the weights tell the solution, in steps; 1: at the end
/// @source HairerWanner1996, IV.7
inline std::vector<double> violations(const std::vector<RootedTree>& trees, const std::vector<std::vector<Quad>>& alpha,
                                      const std::vector<std::vector<Quad>>& beta, const std::vector<Quad>& b,
                                      const Quad& theta = Quad(1)) {
  const std::size_t s = b.size();
  std::vector<double> worst(static_cast<std::size_t>(trees.back().order) + 1, 0);
  std::vector<std::vector<Quad>> phis;
  for (const RootedTree& tree : trees) {
    const auto& a = tree.branches.size() == 1 ? beta : alpha;
    std::vector<Quad> phi(s, Quad(1));
    for (const std::size_t branch : tree.branches) {
      for (std::size_t i = 0; i < s; ++i) {
        Quad sum = 0;
        for (std::size_t j = 0; i < a.size() && j < std::min(a[i].size(), s); ++j) sum += a[i][j] * phis[branch][j];
        phi[i] *= sum;
      }
    }
    Quad weight = 0, expected = Quad(1) / Quad(tree.density);
    for (std::size_t i = 0; i < s; ++i) weight += b[i] * phi[i];
    for (int k = 0; k < tree.order; ++k) expected *= theta;
    phis.push_back(std::move(phi));
    double& present = worst[static_cast<std::size_t>(tree.order)];
    present = std::max(present, static_cast<double>(abs(weight - expected)));
  }
  return worst;
}

/// The same of a Runge-Kutta method:
///
///     sum_i b_i phi_i(tree) = 1 / density,   phi_i(tree) = prod over branches of sum_j a_ij phi_j(branch)
inline std::vector<double> violations(const std::vector<RootedTree>& trees, const std::vector<std::vector<Quad>>& a,
                                      const std::vector<Quad>& b) {
  return violations(trees, a, a, b);
}

/// The order of a method whose coefficients are printed to about `digits`: conditions beyond it are violated.
inline int order_of(const std::vector<double>& violated, double digits) {
  int order = 0;
  while (order + 1 < static_cast<int>(violated.size()) && violated[static_cast<std::size_t>(order) + 1] < digits) {
    ++order;
  }
  return order;
}

/// Weights without others: those of an embedded formula, which tables give by their difference.
inline std::vector<Quad> without(std::vector<Quad> a, const std::vector<Quad>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

/// x with its tenth digit changed by one.
inline Quad slip(const Quad& x) {
  const double size = std::floor(std::log10(std::abs(static_cast<double>(x))));
  return x + Quad(std::pow(10.0, size - 9));
}

}  // namespace noether::test

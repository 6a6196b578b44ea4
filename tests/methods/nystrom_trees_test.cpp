/// The Runge-Kutta-Nystroem pair 12(10) against the order conditions of all its rooted trees.

#include "integrators/methods/nystrom_tableaus.hpp"
#include "tests/methods/rooted_trees.hpp"
#include "tests/support/catch.hpp"

using namespace noether;

namespace {

/// A tree of q'' = f(q): a force whose branches are velocities, of order 1, and forces, by their numbers in the list of
/// all trees. Such a force is of order 2 and the orders of its branches more.
///
/// Where q(t) is put together of such terms, that of this tree is t^order `share`: two integrals of
/// t^(order - 2) times the shares of the branches.
struct NystromTree {
  int velocities = 0;
  std::vector<std::size_t> forces;
  int order = 2;
  Quad share = Quad(1) / Quad(2);
};

/// Adds all trees of `order` whose further branches have order `left` together, forces with numbers up to `last`.
void grow(std::vector<NystromTree>& trees, int order, int left, std::size_t last, std::vector<std::size_t>& forces) {
  Quad share = Quad(1) / Quad(order * (order - 1));
  for (const std::size_t force : forces) share *= trees[force].share;
  trees.push_back({left, forces, order, share});
  for (std::size_t k = 0; k <= last; ++k) {
    if (trees[k].order > left) break;
    forces.push_back(k);
    grow(trees, order, left - trees[k].order, k, forces);
    forces.pop_back();
  }
}

/// All trees up to order `most`: 1, 1, 2, 3, 6, 10, 20, 36, ... from order 2 on. @source HairerNoersettWanner1993,
/// II.14
std::vector<NystromTree> nystrom_trees(int most) {
  std::vector<NystromTree> trees{{}};
  for (int order = 3; order <= most; ++order) {
    std::vector<std::size_t> forces;
    grow(trees, order, order - 2, trees.size() - 1, forces);
  }
  return trees;
}

/// What the conditions of each order are violated by: [p] is the worst of order p.
struct Violations {
  std::vector<double> position, velocity;
};

/// The conditions of a tree, its order n:
///
///     sum_i b_q,i phi_i = share            for q(h), order n
///     sum_i b_v,i phi_i = n share          for v(h), order n - 1
///     phi_i = c_i^velocities prod over forces of sum_j a_ij phi_j(force)
Violations violations(const std::vector<NystromTree>& trees, const NystromTableau& t, const std::vector<Quad>& b_q,
                      const std::vector<Quad>& b_v) {
  const auto orders = static_cast<std::size_t>(trees.back().order) + 1;
  Violations worst{std::vector<double>(orders, 0), std::vector<double>(orders, 0)};
  const auto note = [](double& present, const Quad& difference) {
    present = std::max(present, static_cast<double>(abs(difference)));
  };
  // sums[tree][i] = sum_j a_ij phi_j(tree): what a branch gives to the force that it hangs on.
  std::vector<std::vector<Quad>> sums;
  for (const NystromTree& tree : trees) {
    std::vector<Quad> phi(t.stages(), Quad(1)), sum(t.stages(), Quad(0));
    Quad position = 0, velocity = 0;
    for (std::size_t i = 0; i < t.stages(); ++i) {
      for (int k = 0; k < tree.velocities; ++k) phi[i] *= t.c[i];
      for (const std::size_t force : tree.forces) phi[i] *= sums[force][i];
      for (std::size_t j = 0; j < t.a[i].size(); ++j) sum[i] += t.a[i][j] * phi[j];
      position += b_q[i] * phi[i];
      velocity += b_v[i] * phi[i];
    }
    sums.push_back(std::move(sum));
    const auto order = static_cast<std::size_t>(tree.order);
    note(worst.position[order], position - tree.share);
    note(worst.velocity[order - 1], velocity - Quad(tree.order) * tree.share);
  }
  return worst;
}

/// Conditions are met to the digits that the table is printed with, or not by far.
constexpr double printed = 1e-28;

/// The order up to which both are met. The last order of `velocity` lacks trees, and is not asked for.
int order_of(const Violations& violated) {
  return std::min(test::order_of(violated.position, printed), test::order_of(violated.velocity, printed));
}

/// Whether rows fit their nodes: sum_j a_ij = c_i^2 / 2, and from the third on sum_j a_ij c_j = c_i^3 / 6.
bool rows_fit(const NystromTableau& t) {
  for (std::size_t i = 0; i < t.stages(); ++i) {
    Quad sum = t.c[i] * t.c[i] / Quad(-2), moment = t.c[i] * t.c[i] * t.c[i] / Quad(-6);
    for (std::size_t j = 0; j < t.a[i].size(); ++j) {
      sum += t.a[i][j];
      moment += t.a[i][j] * t.c[j];
    }
    if (static_cast<double>(abs(sum)) > 1e-30 || (i > 1 && static_cast<double>(abs(moment)) > 1e-30)) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("there are as many trees of second-order systems as books count", "[methods]") {
  std::vector<int> count(14, 0);
  for (const auto& tree : nystrom_trees(13)) ++count[static_cast<std::size_t>(tree.order)];
  CHECK(count == std::vector<int>{0, 0, 1, 1, 2, 3, 6, 10, 20, 36, 72, 137, 275, 541});
}

TEST_CASE("the Nystroem pair satisfies all conditions of its orders, 12 and 10, and violates the next", "[methods]") {
  const NystromTableau& t = tableaus::dprkn_12();
  REQUIRE(t.stages() == 17);
  CHECK(rows_fit(t));
  const auto trees = nystrom_trees(14);
  const auto upper = violations(trees, t, t.b_q, t.b_v);
  CAPTURE(upper.position, upper.velocity);
  CHECK(order_of(upper) == 12);
  CHECK(std::max(upper.position[13], upper.velocity[13]) > 1e-12);
  const auto lower = violations(trees, t, test::without(t.b_q, t.e_q), test::without(t.b_v, t.e_v));
  CAPTURE(lower.position, lower.velocity);
  CHECK(order_of(lower) == 10);
  CHECK(std::max(lower.position[11], lower.velocity[11]) > 1e-10);
}

TEST_CASE("one digit changed in any coefficient of the Nystroem pair is found", "[methods]") {
  const NystromTableau& t = tableaus::dprkn_12();
  const auto trees = nystrom_trees(9);
  const auto found = [&](const NystromTableau& changed) {
    // 8, not 9: conditions of velocities are of the order below that of their trees.
    const auto upper = violations(trees, changed, changed.b_q, changed.b_v);
    const auto lower =
        violations(trees, changed, test::without(changed.b_q, changed.e_q), test::without(changed.b_v, changed.e_v));
    return !rows_fit(changed) || order_of(upper) < 8 || order_of(lower) < 8;
  };
  CHECK(!found(t));
  const auto check = [&](const char* what, std::size_t i, std::vector<Quad> NystromTableau::*weights) {
    if ((t.*weights)[i] == Quad(0)) return;
    NystromTableau changed = t;
    (changed.*weights)[i] = test::slip((changed.*weights)[i]);
    CAPTURE(what, i);
    CHECK(found(changed));
  };
  for (std::size_t i = 0; i < t.stages(); ++i) {
    for (std::size_t j = 0; j < t.a[i].size(); ++j) {
      if (t.a[i][j] == Quad(0)) continue;
      NystromTableau changed = t;
      changed.a[i][j] = test::slip(changed.a[i][j]);
      CAPTURE(i, j);
      CHECK(found(changed));
    }
    check("node", i, &NystromTableau::c);
    check("weight of the velocity", i, &NystromTableau::b_v);
    check("weight of the position", i, &NystromTableau::b_q);
    check("error of the velocity", i, &NystromTableau::e_v);
    check("error of the position", i, &NystromTableau::e_q);
  }
}

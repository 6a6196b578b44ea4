/// Tableaus of Runge-Kutta methods against the order conditions of all rooted trees.

#include "tests/methods/rooted_trees.hpp"
#include "integrators/methods/diagonally_implicit_tableaus.hpp"
#include "integrators/methods/explicit_tableaus.hpp"
#include "tests/support/catch.hpp"

#include <string>

using namespace noether;
using test::order_of;
using test::rooted_trees;
using test::slip;
using test::violations;
using test::without;

namespace {

/// One line for each set of weights: what it is, the order it claims, and to what its coefficients are printed.
struct WeightsCase {
  std::string name;
  const Tableau& table;
  std::vector<Quad> b;
  int order;
  double digits;
};

std::vector<WeightsCase> weights_cases() {
  const auto plain = [](const char* name, const Tableau& t, double digits) {
    return WeightsCase{name, t, t.b, t.order, digits};
  };
  const Tableau &dp = tableaus::dormand_prince_5(), &ck = tableaus::cash_karp_5(), &dop = tableaus::dop853();
  return {plain("euler", tableaus::euler(), 1e-32),
          plain("heun", tableaus::heun(), 1e-32),
          plain("rk4", tableaus::rk4(), 1e-32),
          plain("dormand_prince_5", dp, 1e-30),
          {"dormand_prince_5, embedded", dp, without(dp.b, dp.e), 4, 1e-30},
          plain("cash_karp_5", ck, 1e-30),
          {"cash_karp_5, embedded", ck, without(ck.b, ck.e), 4, 1e-30},
          plain("dop853", dop, 1e-26),
          {"dop853, order 5", dop, without(dop.b, dop.e), 5, 1e-26},
          {"dop853, order 3", dop, without(dop.b, tableaus::dop853_third_order_error()), 3, 1e-26},
          plain("backward_euler", tableaus::backward_euler(), 1e-32),
          plain("trapezoidal", tableaus::trapezoidal(), 1e-32),
          plain("sdirk_2", tableaus::sdirk_2(), 1e-32),
          plain("sdirk_3", tableaus::sdirk_3(), 1e-31),
          plain("sdirk_4", tableaus::sdirk_4(), 1e-31)};
}

/// Whether a tableau passes for what it says: order, nodes, and the last row if it is used again.
bool passes(const std::vector<test::RootedTree>& trees, const Tableau& t, const std::vector<Quad>& b, int order,
            double digits) {
  const auto violated = violations(trees, t.a, b);
  for (int p = 1; p <= order; ++p) {
    if (violated[static_cast<std::size_t>(p)] >= digits) return false;
  }
  const auto sums = row_sums(t.a);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (static_cast<double>(abs(sums[i] - t.c[i])) >= digits) return false;
  }
  if (!t.first_same_as_last) return true;
  for (std::size_t j = 0; j < t.a.back().size(); ++j) {
    if (t.a.back()[j] != t.b[j]) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("there are as many rooted trees as Cayley counted", "[methods]") {
  const auto trees = rooted_trees(9);
  std::vector<int> count(10, 0);
  for (const auto& tree : trees) ++count[static_cast<std::size_t>(tree.order)];
  CHECK(count == std::vector<int>{0, 1, 1, 2, 4, 9, 20, 48, 115, 286});
  // The tall tree of n nodes has density n!, the bushy one n.
  long most = 0, least = 1000000;
  for (const auto& tree : trees) {
    if (tree.order != 9) continue;
    most = std::max(most, tree.density);
    least = std::min(least, tree.density);
  }
  CHECK(most == 362880);
  CHECK(least == 9);
}

TEST_CASE("every tableau satisfies all conditions of its order and violates the next", "[methods]") {
  const auto trees = rooted_trees(9);
  for (const WeightsCase& one : weights_cases()) {
    const auto violated = violations(trees, one.table.a, one.b);
    CAPTURE(one.name, violated[static_cast<std::size_t>(one.order)], violated[static_cast<std::size_t>(one.order) + 1]);
    CHECK(order_of(violated, one.digits) == one.order);
    CHECK(violated[static_cast<std::size_t>(one.order) + 1] > 1e-7);
    CHECK(passes(trees, one.table, one.b, one.order, one.digits));
  }
}

TEST_CASE("one digit changed in any coefficient of a tableau is found", "[methods]") {
  const auto trees = rooted_trees(8);
  for (const WeightsCase& one : weights_cases()) {
    const auto found = [&](const Tableau& t, const std::vector<Quad>& b) {
      return !passes(trees, t, b, one.order, one.digits);
    };
    for (std::size_t i = 0; i < one.b.size(); ++i) {
      if (one.b[i] == Quad(0)) continue;
      auto b = one.b;
      b[i] = slip(b[i]);
      CAPTURE(one.name, i);
      CHECK(found(one.table, b));
    }
    for (std::size_t i = 0; i < one.table.a.size(); ++i) {
      for (std::size_t j = 0; j < one.table.a[i].size(); ++j) {
        if (one.table.a[i][j] == Quad(0)) continue;
        Tableau changed = one.table;
        changed.a[i][j] = slip(changed.a[i][j]);
        CAPTURE(one.name, i, j);
        CHECK(found(changed, one.b));
      }
      if (one.table.c[i] == Quad(0)) continue;
      Tableau changed = one.table;
      changed.c[i] = slip(changed.c[i]);
      CAPTURE(one.name, i);
      CHECK(found(changed, one.b));
    }
  }
}

TEST_CASE("the nodes of DOP853, sums of its rows, are the ones its authors give", "[methods]") {
  const auto& c = tableaus::dop853().c;
  const auto near = [&](std::size_t stage, Quad value) {
    CAPTURE(stage);
    CHECK(static_cast<double>(abs(c[stage - 1] - value)) < 1e-27);
  };
  const Quad six = sqrt(Quad(6));
  near(4, (Quad(6) - six) / Quad(30));
  near(5, (Quad(6) + six) / Quad(30));
  near(2, Quad(4) / Quad(9) * c[3]);
  near(3, Quad(2) / Quad(3) * c[3]);
  near(6, Quad(1) / Quad(3));
  near(7, Quad(1) / Quad(4));
  near(8, Quad(4) / Quad(13));
  near(9, Quad(127) / Quad(195));
  near(10, Quad(3) / Quad(5));
  near(11, Quad(6) / Quad(7));
  near(12, Quad(1));
}

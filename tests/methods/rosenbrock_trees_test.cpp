/// Tables of Rosenbrock methods against the order conditions of all rooted trees, and against those made for stiffness.

#include "integrators/methods/rosenbrock.hpp"
#include "integrators/methods/tableau.hpp"
#include "tests/methods/rooted_trees.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace noether::test::rosenbrock {
namespace {

using Row = std::vector<Quad>;
using Rows = std::vector<Row>;

/// Coefficients are printed to 16 digits, some of them above 100: conditions hold to this.
constexpr double printed = 3e-14;

/// A method as its authors derive it:
///
///     k_i = f(t + alpha_i h, y + h sum alpha_ij k_j) + h J sum gamma_ij k_j + h gamma_i df/dt
///     y1  = y + h sum b_i k_i
///
/// alpha_i and gamma_i are sums of rows. The form without products by J has u = h Gamma k, so that a = alpha Gamma^-1,
/// C = 1/g - Gamma^-1, and weights of u are those of k times Gamma^-1.
/// @source HairerWanner1996, IV.7
struct Derived {
  Rows alpha, gamma, beta;  ///< lower triangular, shape (s, s); beta = alpha + gamma
  Row b, embedded;
};

/// The weights of k, from those of u.
Row weights(const Row& of_u, const Rows& gamma) {
  Row of_k(gamma.size(), Quad(0));
  for (std::size_t i = 0; i < of_u.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) of_k[j] += of_u[i] * gamma[i][j];
  }
  return of_k;
}

Derived derived(const RosenbrockTable& t) {
  const std::size_t s = t.b.size();
  Derived d;
  d.gamma.assign(s, Row(s, Quad(0)));
  for (std::size_t i = 0; i < s; ++i) {  // (1/g - C) Gamma = 1
    for (std::size_t k = 0; k < t.c[i].size(); ++k) {
      for (std::size_t j = 0; j <= k; ++j) d.gamma[i][j] += t.g * t.c[i][k] * d.gamma[k][j];
    }
    d.gamma[i][i] = t.g;
    d.alpha.push_back(weights(t.a[i], d.gamma));
    d.beta.push_back(d.alpha[i]);
    for (std::size_t j = 0; j < s; ++j) d.beta[i][j] += d.gamma[i][j];
  }
  d.b = weights(t.b, d.gamma);
  Row others = t.b;  // the last u is the estimate of the error
  others.back() = Quad(0);
  d.embedded = weights(others, d.gamma);
  return d;
}

/// The weights of the polynomial of a step at theta.
Row inside(const RosenbrockTable& t, const Quad& theta, const Rows& gamma) {
  Row of_u(t.b.size(), Quad(0));
  for (std::size_t j = 0; j < of_u.size(); ++j) {
    for (std::size_t r = t.dense.size(); r-- > 0;) {
      of_u[j] = of_u[j] * theta + (j < t.dense[r].size() ? t.dense[r][j] : Quad(0));
    }
    of_u[j] = theta * (t.b[j] + (Quad(1) - theta) * of_u[j]);
  }
  return weights(of_u, gamma);
}

double apart(const Row& x, const Row& y) {
  double worst = 0;
  for (std::size_t i = 0; i < std::max(x.size(), y.size()); ++i) {
    const Quad one = i < x.size() ? x[i] : Quad(0), other = i < y.size() ? y[i] : Quad(0);
    worst = std::max(worst, static_cast<double>(abs(one - other)));
  }
  return worst;
}

/// The largest of b^T beta^j (2 beta^2 1 - alpha^2), j = 0, ..., s - 1: all 0 if, however stiff y' = lambda (y - phi) +
/// phi' is, phi may be a parabola.
double parabolic(const Derived& d) {
  const auto apply = [&](const Row& x) {
    Row y;
    for (const Row& row : d.beta) {
      y.emplace_back(0);
      for (std::size_t j = 0; j < x.size(); ++j) y.back() += row[j] * x[j];
    }
    return y;
  };
  const Row nodes = row_sums(d.alpha);
  Row x = apply(row_sums(d.beta));
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = Quad(2) * x[i] - nodes[i] * nodes[i];
  double worst = 0;
  for (std::size_t j = 0; j < x.size(); ++j) {
    Quad sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += d.b[i] * x[i];
    worst = std::max(worst, static_cast<double>(abs(sum)));
    x = apply(x);
  }
  return worst;
}

/// What one step of length 1 on y' = z (y - phi) + phi', phi = t^k, y(0) = phi(0), is off phi(1).
double off_power(const Derived& d, const Row& b, int k, double stiffness) {
  const Quad z(stiffness);
  const auto power = [](const Quad& x, int n) {
    Quad p = 1;
    for (int i = 0; i < n; ++i) p *= x;
    return p;
  };
  const Row nodes = row_sums(d.alpha), gammas = row_sums(d.gamma);
  const Quad first = k == 1 ? 1 : 0, second = k == 2 ? 2 : 0;  // phi' and phi'' at 0
  Quad y = 0;
  Row rate;
  for (std::size_t i = 0; i < b.size(); ++i) {
    Quad right = Quad(k) * power(nodes[i], k - 1) - z * power(nodes[i], k) + gammas[i] * (second - z * first);
    for (std::size_t j = 0; j < i; ++j) right += z * d.beta[i][j] * rate[j];
    rate.push_back(right / (Quad(1) - z * d.beta[i][i]));
    y += b[i] * rate[i];
  }
  return std::abs(static_cast<double>(y - Quad(1)));
}

/// Whether a table passes for what it says: the orders of its two results and of its polynomial, its nodes and factors
/// of df/dt, both results at t + h and stiffly accurate, for which conditions of differential-algebraic equations hold.
bool passes(const std::vector<RootedTree>& trees, const RosenbrockTable& t, bool against_reduction) {
  const Derived d = derived(t);
  const std::size_t s = t.b.size();
  const auto holds = [&](const Row& b, int order, const Quad& theta) {
    return order_of(violations(trees, d.alpha, d.beta, b, theta), printed) >= order;
  };
  return holds(d.b, t.order, Quad(1)) && holds(d.embedded, t.embedded_order, Quad(1)) &&
         holds(inside(t, Quad(0.25), d.gamma), t.order - 1, Quad(0.25)) &&
         holds(inside(t, Quad(0.75), d.gamma), t.order - 1, Quad(0.75)) &&
         apart(row_sums(d.alpha), t.nodes) < printed && apart(row_sums(d.gamma), t.d) < printed &&
         t.nodes[s - 1] == Quad(1) && t.nodes[s - 2] == Quad(1) && apart(d.b, d.beta[s - 1]) < printed &&
         apart(d.embedded, d.beta[s - 2]) < printed && (!against_reduction || parabolic(d) < printed);
}

struct TableCase {
  std::string name;
  const RosenbrockTable& table;
  bool against_reduction;
};

std::vector<TableCase> tables() {
  return {{"rodas_4", tableaus::rodas_4(), false}, {"rodas_5p", tableaus::rodas_5p(), true}};
}

/// The last u of Rodas5P is the difference of two results of order 4 at least, so that a polynomial of order 4 may have
/// any part of it. These three weights were compared with other programs that have the table.
bool is_free(const TableCase& one, std::string_view which, std::size_t i) {
  return one.name == "rodas_5p" && which == "dense" && i + 1 == one.table.b.size();
}

TEST_CASE("every Rosenbrock table satisfies all conditions of its order and violates the next", "[methods]") {
  const auto trees = rooted_trees(6);
  for (const TableCase& one : tables()) {
    const RosenbrockTable& table = one.table;
    const Derived d = derived(table);
    const auto check = [&](const char* what, const Row& b, int order, double theta) {
      const auto violated = violations(trees, d.alpha, d.beta, b, Quad(theta));
      CAPTURE(one.name, what, theta, violated);
      CHECK(order_of(violated, printed) == order);
      CHECK(violated[static_cast<std::size_t>(order) + 1] > 5e-4);
    };
    check("result", d.b, table.order, 1);
    check("embedded", d.embedded, table.embedded_order, 1);
    for (const double theta : {0.25, 0.5, 0.75}) {
      check("polynomial", inside(table, Quad(theta), d.gamma), table.order - 1, theta);
    }
    CHECK(passes(trees, table, one.against_reduction));
  }
  CHECK(tableaus::rodas_4().order == 4);
  CHECK(tableaus::rodas_4().embedded_order == 3);
  CHECK(tableaus::rodas_5p().order == 5);
  CHECK(tableaus::rodas_5p().embedded_order == 4);
}

TEST_CASE("conditions of Rosenbrock methods are not those of Runge-Kutta methods", "[methods]") {
  const auto trees = rooted_trees(6);
  for (const TableCase& one : tables()) {
    CAPTURE(one.name);
    const Derived d = derived(one.table);
    CHECK(order_of(violations(trees, d.alpha, d.b), printed) <= 2);
    CHECK(order_of(violations(trees, d.beta, d.b), printed) == 2);
  }
}

TEST_CASE("Rodas5P meets the conditions for parabolic equations, Rodas4 does not", "[methods]") {
  const Derived d4 = derived(tableaus::rodas_4()), d5 = derived(tableaus::rodas_5p());
  CHECK(parabolic(d5) < printed);
  CHECK(parabolic(d4) > 5e-5);
  for (const double z : {-1e-3, -1.0, -30.0, -1e6, 0.5}) {
    CAPTURE(z);
    for (const Row& b : {d5.b, d5.embedded}) {
      for (const int k : {1, 2, 3}) CHECK(off_power(d5, b, k, z) < printed);
    }
    for (const Row& b : {d4.b, d4.embedded}) CHECK(off_power(d4, b, 1, z) < printed);
  }
  CHECK(off_power(d5, d5.b, 4, -1) > 1e-3);
  CHECK(off_power(d4, d4.b, 2, -1) > 1e-5);
}

TEST_CASE("one digit changed in any coefficient of a Rosenbrock table is found", "[methods]") {
  const auto trees = rooted_trees(5);
  for (const TableCase& one : tables()) {
    int changes = 0;
    const auto check = [&](const std::string& which, const auto& list_of) {
      RosenbrockTable changed = one.table;
      for (std::size_t i = 0; i < list_of(changed).size(); ++i) {
        changed = one.table;
        Quad& x = list_of(changed)[i];
        if (x == Quad(0)) continue;
        x = slip(x);
        ++changes;
        CAPTURE(one.name, which, i);
        CHECK(passes(trees, changed, one.against_reduction) == is_free(one, which, i));
      }
    };
    const auto check_rows = [&](const std::string& which, Rows RosenbrockTable::*part) {
      for (std::size_t r = 0; r < (one.table.*part).size(); ++r) {
        CAPTURE(r);
        check(which, [&](RosenbrockTable& t) -> Row& { return (t.*part)[r]; });
      }
    };
    check_rows("a", &RosenbrockTable::a);
    check_rows("c", &RosenbrockTable::c);
    check_rows("dense", &RosenbrockTable::dense);
    check("b", [](RosenbrockTable& t) -> Row& { return t.b; });
    check("nodes", [](RosenbrockTable& t) -> Row& { return t.nodes; });
    check("d", [](RosenbrockTable& t) -> Row& { return t.d; });
    CHECK(changes > 50);
    RosenbrockTable changed = one.table;
    changed.g = slip(changed.g);
    CHECK_FALSE(passes(trees, changed, one.against_reduction));
  }
}

}  // namespace
}  // namespace noether::test::rosenbrock

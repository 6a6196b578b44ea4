/// What is in print of methods on groups of rotations, by the figures of docs/claims.md.

#include "integrators/first_order_system.hpp"
#include "integrators/lie/graded_brackets.hpp"
#include "integrators/methods/explicit_tableaus.hpp"
#include "tests/lie/top_errors.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace noether {
namespace {

using test::turning;

/// A free body of moments (2, 1, 2/3) as a matrix that is no group to its method: R' = R hat(Pi/I), Pi' = Pi x Pi/I.
struct MatrixOfBody {
  Index size() const { return 12; }
  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const {
    const Vec3<Real> pi(y[9], y[10], y[11]), rate(pi[0] / Real(2), pi[1], pi[2] * Real(1.5));
    for (Index i = 0; i < 3; ++i) {
      const Vec3<Real> row(y[3 * i], y[3 * i + 1], y[3 * i + 2]), moved = cross<Real>(row, rate);
      for (Index k = 0; k < 3; ++k) dy[3 * i + k] = moved[k];
    }
    const Vec3<Real> twist = cross<Real>(pi, rate);
    for (Index k = 0; k < 3; ++k) dy[9 + k] = twist[k];
  }
};

/// Fehlberg's table of order 7, of his pair with order 8.
Tableau fehlberg_7() {
  Tableau table{.a = rows({"", "2/27", "1/36 1/12", "1/24 0 1/8", "5/12 0 -25/16 25/16", "1/20 0 0 1/4 1/5",
                           "-25/108 0 0 125/108 -65/27 125/54", "31/300 0 0 0 61/225 -2/9 13/900",
                           "2 0 0 -53/6 704/45 -107/9 67/90 3", "-91/108 0 0 23/108 -976/135 311/54 -19/60 17/6 -1/12",
                           "2383/4100 0 0 -341/164 4496/1025 -301/82 2133/4100 45/82 45/164 18/41"}),
                .b = coefficients("41/840 0 0 0 0 34/105 9/35 9/35 9/280 9/280 41/840"),
                .c = {},
                .order = 7};
  table.c = row_sums(table.a);
  return table;
}

}  // namespace

TEST_CASE("C25: the variational body keeps its angular momentum in space, not in the body", "[claims][lie]") {
  const RotatingOptions discrete{.rotor = Rotor::variational};
  Simulation sim(test::free_body(), compose(turning(ForceField<double>{}, discrete), schemes::verlet), 0.1);
  const ParticleSystem<double> start = test::free_body();
  double farthest = 0, size = 0;
  for (int n = 0; n < 10'000; ++n) {
    REQUIRE(sim.run(1).ok());
    const Vec3<double> pi = test::in_body_of(sim.particles());
    farthest = std::max(farthest, (pi - test::in_body_of(start)).cwiseAbs().maxCoeff());
    size = std::max(size, std::abs(pi.norm() - 1));
    if (n == 99) CHECK(std::abs(test::free_body_distance(sim.particles()) / 1.60e-2 - 1) < 0.05);
  }
  CHECK(std::abs(farthest / 0.91 - 1) < 0.05);
  CHECK(size < 7e-15);
  CHECK(sim.particles().column<BodySpin>()[0] == start.column<BodySpin>()[0]);
  CHECK(std::abs(turning_energy_of(sim.particles()) / turning_energy_of(start) - 1) < 5e-15);
}

TEST_CASE("C26: a matrix that Kutta's method steps is not a rotation after a while", "[claims][lie]") {
  std::vector<double> y = {1, 0, 0, 0, 1, 0, 0, 0, 1, std::cos(1.1), 0, std::sin(1.1)};
  Simulation sim(initial_state(MatrixOfBody{}, y), classical(MatrixOfBody{}, method("rk4")), 0.1);
  REQUIRE(sim.run(10'000).ok());
  const auto& end = sim.particles().variables();
  double defect = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      double product = i == k ? -1 : 0;
      for (std::size_t j = 0; j < 3; ++j) product += end[3 * j + i] * end[3 * j + k];
      defect = std::max(defect, std::abs(product));
    }
  }
  CHECK(std::abs(defect / 7.9e-4 - 1) < 0.05);
}

TEST_CASE("C34: commutators are reduced to 5 for a pair of orders 4 and 5 and to 21 for order 7", "[claims][lie]") {
  CHECK(bracket_dimensions(tableaus::rk4()) == std::vector<int>{1, 1});
  CHECK(bracket_dimensions(tableaus::dormand_prince_5()) == std::vector<int>{1, 3, 1});
  CHECK(bracket_dimensions(tableaus::cash_karp_5()) == std::vector<int>{1, 3, 1});
  CHECK(least_commutators(tableaus::dormand_prince_5()) == 5);
  CHECK(bracket_dimensions(tableaus::dop853()) == std::vector<int>{1, 3, 6, 10, 10, 1});
  CHECK(bracket_dimensions(fehlberg_7()) == std::vector<int>{1, 3, 6, 10, 1});
  CHECK(least_commutators(fehlberg_7()) == 21);
}

}  // namespace noether

/// Newton's method on molecules whose sweeps converge slowly or never: see claims_test.cpp.

#include "tests/support/catch.hpp"
#include "tests/support/mechanisms.hpp"

#include <random>

namespace noether {
namespace {

using Places = std::vector<Vec3<double>>;

constexpr double bond = 0.153;  // of carbons [nm]

/// A zigzag of carbons at 112 degrees.
Places carbon_chain(int n) {
  const double half = 112 * M_PI / 360;
  Places x;
  for (int i = 0; i < n; ++i) x.emplace_back(i * bond * std::sin(half), i % 2 * bond * std::cos(half), 0);
  return x;
}

TEST_CASE("Newton's method needs a few iterations where sweeps need hundreds, and none of them fails",
          "[constraints][claims]") {
  for (const int n : {10, 50}) {
    const Places places = carbon_chain(n);
    ParticleSystem<double> s(unit_system("molecular"));
    for (std::size_t i = 0; i < places.size(); ++i) s.add("C" + std::to_string(i), 12.011, places[i], {0, 0, 0});
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (Index i = 0; i < s.size(); ++i) {
      for (Index k = 0; k < 3; ++k)
        s.velocities()[i][k] = std::sqrt(units::molecular::k_B * 300 / 12.011) * normal(random);
    }
    ConstraintSet set;
    for (const Index apart : {1, 2}) {
      for (Index i = 0; i + apart < n; ++i) set.add(s, Distance{}, {i, i + apart});
    }
    ConstraintSolver<double> solver(set);
    solver.bind(s);
    solver.advance_positions(s, 0.002);
    REQUIRE(!solver.failure());
    CHECK(solver.iterations() <= 12);
    CHECK(set.worst(s).residual < 0x1p-53 * 4 * (0.13 * n / bond + 1));
  }
}

}  // namespace
}  // namespace noether

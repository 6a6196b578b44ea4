// An invariant from outside the library as a decorator of scenes: under its own name, and in the list.

#include "integrators/projected.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/kepler_pair.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace noether::test {

/// Angular momentum about z, held as a part of scenes.
struct HeldTurn {
  double tolerance = 0;

  static constexpr auto describe() {
    return part<HeldTurn>("held_turn", "holds the angular momentum about z",
                          field<&HeldTurn::tolerance>("tolerance", "1", "that is left"));
  }
};
struct TurnAboutZ {
  template <class Real> Real operator()(const ParticleState<Real>& s) const {
    Real sum(0);
    for (Index i = 0; i < s.size(); ++i) sum += s.m(i) * cross(s.x(i), s.v(i))[2];
    return sum;
  }
};
template <Integrator I> auto around(const HeldTurn& part, I integrator) {
  return projected(std::move(integrator), {.tolerance = part.tolerance}, TurnAboutZ{});
}

namespace {

const std::string pair_by_rk4 = R"(units = "reduced"
[[particles.body]]
name = "one"
mass = 0.75
x = [0, 0, 0]
v = [0, 0, 0]
[[particles.body]]
name = "other"
mass = 0.25
x = [0.4, 0, 0]
v = [0, 2, 0]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "gravity"
[integrator]
method = "rk4"
step = 0.05
steps = 100
)";

double turn_after(const std::string& tables) {
  Parts parts = standard_parts();
  parts.add_decorator<HeldTurn>();
  Simulation<double> sim = assemble(read_scene(pair_by_rk4 + tables, "scene.toml", parts));
  const double before = pairs::angular_momentum_of_pair(sim.particles())[2];
  REQUIRE(sim.run(100).ok());
  return std::abs(pairs::angular_momentum_of_pair(sim.particles())[2] - before);
}

}  // namespace

TEST_CASE("an invariant from outside the library is projected onto in a scene", "[scene][projected]") {
  CHECK(turn_after("") > 1e-9);
  CHECK(turn_after("[integrator.held_turn]\n") < 1e-15);
  CHECK(turn_after("[integrator.held_turn]\ntolerance = 1e-12\n") < 1e-12);
  CHECK(turn_after("[[integrator.decorator]]\ntype = \"held_turn\"\n") < 1e-15);
  CHECK(turn_after("[integrator.held_turn]\n[integrator.projection]\nonto = [\"energy\"]\n") < 1e-9);
}

}  // namespace noether::test

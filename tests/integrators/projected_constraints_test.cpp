/// Projection of RATTLE onto its energy and its constraints, along gradients and along flows.

#include "integrators/projected.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/mechanisms.hpp"

#include <string>

namespace noether {
namespace {

using Catch::Matchers::Contains;

double energy_of_mechanism(const test::Mechanism& mechanism, const ParticleSystem<double>& settled) {
  AnyHamiltonian<double> hamiltonian = test::hamiltonian_of(mechanism);
  ParticleSystem<double> s = settled;
  hamiltonian.bind(s);
  return hamiltonian.energy(s).total();
}
/// Largest |dg/dt| of the double pendulum.
double worst_rate_of_rods(const ParticleSystem<double>& s) {
  const Vec3<double> x = s.positions()[0], v = s.velocities()[0], r = Vec3<double>(s.positions()[1]) - x,
                     w = Vec3<double>(s.velocities()[1]) - v;
  return std::max(std::abs(dot(x, v)), std::abs(dot(r, w)));
}

}  // namespace

TEST_CASE("RATTLE is brought back to its energy without leaving its constraints", "[integrators][projected]") {
  const test::Mechanism pendulum = test::double_pendulum();
  const double before = energy_of_mechanism(pendulum, pendulum.particles);
  for (const ProjectionNorm norm : {ProjectionNorm::mass, ProjectionNorm::plain}) {
    CAPTURE(static_cast<int>(norm));
    const ProjectionOptions options{.onto = {Invariant::energy, Invariant::constraints}, .norm = norm};
    const auto bare = compose(test::hamiltonian_of(pendulum), schemes::verlet);
    Simulation<double> free(pendulum.particles, bare, 0.01),
        held(pendulum.particles, projected(bare, options, pendulum.constraints), 0.01);
    REQUIRE(free.run(300).ok());
    const Outcome outcome = held.run(300);
    INFO(outcome.message);
    REQUIRE(outcome.ok());
    const ParticleSystem<double>& s = held.particles();
    CHECK(std::abs(energy_of_mechanism(pendulum, s) - before) < 1e-12);
    CHECK(std::abs(energy_of_mechanism(pendulum, free.particles()) - before) > 1e-5);
    CHECK(pendulum.constraints.worst(s).residual < 1e-14);
    CHECK(worst_rate_of_rods(s) < 1e-13);
    CHECK(held.evaluations().projection.iterations > 0);
  }
}

TEST_CASE("constraints and their rates are a pair that flows of their own can be projected along",
          "[integrators][projected]") {
  // SHAKE-like: sweeps that leave 1e-5 are brought back to rounding.
  test::Mechanism pendulum = test::double_pendulum();
  ConstraintSet loose = pendulum.constraints.solved_by({.solver = ConstraintMethod::rattle, .tolerance = 1e-5});
  const auto bare = compose(test::kinetic_potential_over(test::field_of(test::weight), loose), schemes::verlet);
  for (const Projection how : {Projection::hamiltonian, Projection::orthogonal}) {
    CAPTURE(static_cast<int>(how));
    Simulation<double> free(pendulum.particles, bare, 0.01),
        held(pendulum.particles, projected(bare, {.onto = {Invariant::constraints}, .how = how}, loose), 0.01);
    REQUIRE(free.run(100).ok());
    const Outcome outcome = held.run(100);
    INFO(outcome.message);
    REQUIRE(outcome.ok());
    CHECK(pendulum.constraints.worst(free.particles()).residual > 1e-9);
    CHECK(pendulum.constraints.worst(held.particles()).residual < 1e-14);
    CHECK(worst_rate_of_rods(held.particles()) < 1e-13);
  }
}

TEST_CASE("constraints are found again far from the origin, where positions are rounded more",
          "[integrators][projected]") {
  // Rods of 1 and 1.5 at a distance of 1e5: rounding of positions makes 1e-11 of their lengths.
  ParticleSystem<double> s;
  s.add("a", 1, {1e5, 0, 0}, {0, 1, 0});
  s.add("b", 2, {1e5 + 1, 0, 0}, {0, 0, 1});
  s.add("c", 3, {1e5 + 1, 1.5, 0}, {-1, 0, 0});
  ConstraintSet rods;
  rods.add(s, Distance{1}, {0, 1}).add(s, Distance{1.5}, {1, 2});
  rods = rods.solved_by({.solver = ConstraintMethod::rattle, .tolerance = 1e-5});
  const auto bare = compose(test::kinetic_potential_over(test::field_of(test::weight), rods), schemes::verlet);
  Simulation<double> held(s, projected(bare, {.onto = {Invariant::constraints}}, rods), 0.01);
  const Outcome outcome = held.run(100);
  INFO(outcome.message);
  REQUIRE(outcome.ok());
  CHECK(rods.worst(held.particles()).residual < 1e-10);
  CHECK(held.evaluations().projection.mean() < 4);
}

TEST_CASE("particles that constraints hold are not moved off them", "[integrators][projected]") {
  const test::Mechanism pendulum = test::double_pendulum();
  const auto bare = compose(test::hamiltonian_of(pendulum), schemes::verlet);
  CHECK_THROWS_WITH(Simulation<double>(pendulum.particles,
                                       projected(bare, {.onto = {Invariant::energy}}, pendulum.constraints), 0.01),
                    Contains("put \"constraints\" into onto"));
  CHECK_THROWS_WITH(Simulation<double>(pendulum.particles,
                                       projected(bare, {.onto = {Invariant::constraints}, .how = Projection::symmetric},
                                                 pendulum.constraints),
                                       0.01),
                    Contains("before each step, which has to begin on them"));
}

}  // namespace noether

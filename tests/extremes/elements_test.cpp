// Elements that are flat, or turned inside out on the way: refused, or ended by name with the element and the step.

#include "forces/hyperelastic.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/classical.hpp"
#include "scene/block.hpp"
#include "tests/extremes/support.hpp"
#include "tests/support/drivers.hpp"

#include <memory>

namespace noether::test {
namespace {

const HyperelasticForce soft{{.lambda = 1, .mu = 0.8}};
const HyperelasticForce neo{{.material = ElasticLaw::neo_hookean, .lambda = 1, .mu = 0.8}};

/// A cube of which one corner flies through the opposite one.
ParticleSystem<double> pierced_cube(double speed) {
  ParticleSystem<double> s = Block{.cells = {1, 1, 1}, .size = {1, 1, 1}, .density = 1}.build();
  s.velocities().set(0, Vec3<double>(speed, speed, speed));
  return s;
}

template <class I> Outcome end_of(I integrator, double step) {
  Simulation<double> sim(pierced_cube(20), std::move(integrator), step);
  return sim.run(400);
}

void check_inverted(const Outcome& outcome) {
  INFO(to_text(outcome));
  CHECK(outcome.kind == Outcome::Kind::inverted_element);
  CHECK(outcome.quantity.starts_with("element "));
  CHECK_THAT(outcome.message, Catch::Contains("is inside out"));
  CHECK(outcome.step > 0);
  CHECK(outcome.step < 100);
}

TEST_CASE("an element that is turned inside out ends the run by its name and step, whatever the method",
          "[extremes][hyperelastic]") {
  for (const HyperelasticForce& force : {soft, neo}) {
    check_inverted(end_of(compose(kinetic_potential(force), schemes::verlet), 0.005));
    check_inverted(end_of(compose(kinetic_potential(force), schemes::blanes_moan_s6), 0.005));
    check_inverted(end_of(classical_over(force, method("rk4")), 0.005));
    check_inverted(end_of(classical_over(force, method("implicit_midpoint")), 0.005));
    check_inverted(end_of(classical_over(force, method("simo_tarnow_wong")), 0.005));
  }
}

TEST_CASE("a mesh with a flat element is refused before the first step", "[extremes][hyperelastic]") {
  for (const double height : {0.0, 1e-12, 1e-9}) {
    ParticleSystem<double> s;
    auto mesh = std::make_shared<Mesh>();
    mesh->rest = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, height}};
    for (const Vec3<double>& x : mesh->rest) s.add("", 1, x, Vec3<double>::Zero());
    mesh->tetrahedra = {{{0, 1, 2, 3}, 0}};
    auto topology = std::make_shared<Topology>();
    topology->mesh = mesh;
    s.set_topology(topology);
    const auto begin = [&] { Simulation<double>(s, compose(kinetic_potential(soft), schemes::verlet), 1e-12); };
    if (height < 1e-10) {
      CHECK_THROWS_WITH(begin(), Catch::Contains("element 0 of the mesh is flat"));
    } else {
      CHECK_NOTHROW(begin());
    }
  }
}

}  // namespace
}  // namespace noether::test

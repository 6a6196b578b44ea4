// Six moons of an oblate Saturn: a force the user wrote, in a program.
#include "examples/oblate_saturn/oblateness.hpp"

#include "engine/simulation.hpp"
#include "forces/check_gradient.hpp"
#include "forces/gravity.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/bodies.hpp"
#include "io/digest.hpp"
#include "monitors/monitors.hpp"
#include "monitors/orbital_monitors.hpp"
#include "numbers/units.hpp"

#include <fmt/format.h>

using namespace noether;
using namespace noether::units::solar;  // km, second, year, G

int main() {
  ParticleSystem moons = io::read_bodies("saturn_moons.csv");  // Saturn first
  const Oblateness j2{.J2 = 16290.7e-6, .radius = 60'330 * km, .mu = G * moons.masses()[0]};
  check_gradient(j2, moons);  // throws if a is not -grad U / m
  move_to_barycenter(moons);

  auto integrator = compose(KineticPotential(Sum(Gravity{}, j2)), schemes::blanes_moan_s6);
  Simulation sim(std::move(moons), std::move(integrator), 600 * second);
  auto& energy = sim.every(144, Energy{});
  auto& elements = sim.every(144, Elements{});

  const Outcome outcome = sim.run_until(10 * year);
  fmt::print("{}: worst energy error {:.1e}\n", outcome, energy.worst());
  fmt::print("node of Mimas at {:.3f} degrees\n", elements.of(1).Omega / degree);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

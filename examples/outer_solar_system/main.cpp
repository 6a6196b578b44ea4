// Sun, Jupiter ... Pluto for a million years.
#include "engine/simulation.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/wisdom_holman.hpp"
#include "io/bodies.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "numbers/units.hpp"

#include <fmt/format.h>

using namespace noether;
using namespace noether::units::solar;  // au, day, year, Msun, G

int main() {
  ParticleSystem planets = io::read_bodies("outer_planets.csv");  // the Sun first
  move_to_barycenter(planets);

  auto integrator = compose(WisdomHolman({.G = 2.95912208286e-4}), schemes::aba_10_6_4, {.compensated = true});
  Simulation sim(std::move(planets), std::move(integrator), 100 * day);
  auto& energy = sim.every(sim.steps_in(10'000 * year), Energy{});
  auto& angular_momentum = sim.every(sim.steps_in(10'000 * year), AngularMomentum{});
  sim.every(sim.steps_in(10'000 * year), io::TrajectoryWriter{"run.h5"});
  sim.stop_when(farther_than(100 * au), 4'000);

  const Outcome outcome = sim.run_until(1e6 * year);
  fmt::print("{} at {:.3g} yr, worst energy error {:.1e}\n", outcome, sim.time() / year, energy.worst());
  fmt::print("worst angular momentum error {:.1e}\n", angular_momentum.worst());
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

// Sun and eight planets for a thousand years, with a step of five days.
#include "engine/simulation.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/wisdom_holman.hpp"
#include "io/bodies.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/orbital_monitors.hpp"
#include "numbers/units.hpp"

#include <fmt/format.h>

using namespace noether;
using namespace noether::units::solar;  // au, day, year, Msun, G

int main() {
  ParticleSystem planets = io::read_bodies("planets.csv");  // the Sun first
  move_to_barycenter(planets);

  auto integrator = compose(WisdomHolman({}), schemes::aba_10_6_4, {.compensated = true});
  Simulation sim(std::move(planets), std::move(integrator), 5 * day);
  auto& energy = sim.every(73, Energy{});
  auto& angular_momentum = sim.every(73, AngularMomentum{});
  auto& elements = sim.every(730, Elements{});
  sim.every(730, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run_until(1000 * year);
  fmt::print("{} at {:.4g} yr, worst energy error {:.1e}\n", outcome, sim.time() / year, energy.worst());
  fmt::print("worst angular momentum error {:.1e}\n", angular_momentum.worst());
  for (Index i = 1; i < sim.particles().size(); ++i) {
    const OrbitalElements<double> o = elements.of(i);
    fmt::print("{:<10} a = {:9.5f} au, e = {:.5f}\n", sim.particles().name(i), o.a, o.e);
  }
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

// Burrau's problem: masses 3, 4, 5 at rest in the corners of the triangle with sides 3, 4, 5.
#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/orbital_monitors.hpp"

#include <fmt/format.h>

using namespace noether;

int main() {
  ParticleSystem bodies;
  bodies.add("three", 3, {1, 3, 0}, {0, 0, 0});
  bodies.add("four", 4, {-2, -1, 0}, {0, 0, 0});
  bodies.add("five", 5, {1, -1, 0}, {0, 0, 0});

  // Four and five pass each other at 4.1e-4 with a speed of 209: that passage, at time 15.83, sets the step.
  Simulation sim(std::move(bodies), compose(KineticPotential(Gravity{}), schemes::srkn14a), 5e-7);
  auto& energy = sim.every(20'000, Energy{});
  auto& closest = sim.every(10, ClosestApproach{});
  sim.every(20'000, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run_until(70);
  fmt::print("{}: energy {:.9f}, worst energy error {:.1e}\n", outcome, energy.total(), energy.worst());
  fmt::print("closest approach {:.3e} at time {:.4f}\n", closest.distance(), closest.at_time());
  for (Index i = 0; i < 3; ++i) {
    const Vec3<double> x = sim.particles().positions()[i];
    fmt::print("{:<6} ({:8.3f}, {:8.3f})\n", sim.particles().name(i), x[0], x[1]);
  }
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

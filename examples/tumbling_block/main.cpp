// A stiff block that tumbles and rings: four methods, and what each makes of its energy.
#include "engine/simulation.hpp"
#include "forces/hyperelastic.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "scene/block.hpp"

#include <fmt/format.h>

using namespace noether;

const Block block{.cells = {4, 1, 1},
                  .size = {2, 0.5, 0.5},
                  .density = 1,
                  .stretch = {1.05, 0.97, 1.02},
                  .angular_velocity = {0.3, 2, 1}};
const HyperelasticForce material{{.lambda = 1000, .mu = 800}};

/// One line of the table. @return how the run ended
Outcome tell(const char* method, double step, Simulation<double> sim) {
  auto& energy = sim.every(1, Energy{});
  auto& turning = sim.every(1, AngularMomentum{});
  const Outcome outcome = sim.run(400);
  fmt::print("{:17} {:6} {:10.1e} {:10.1e}  {}\n", method, step, energy.worst(), turning.worst(), outcome);
  return outcome;
}

int main() {
  fmt::print("{:17} {:>6} {:>10} {:>10}\n", "method", "step", "energy", "turning");
  for (const char* name : {"implicit_midpoint", "newmark"}) {
    static_cast<void>(tell(name, 0.02, Simulation(block.build(), classical(material, method(name)), 0.02)));
  }
  const auto verlet = compose(KineticPotential(material), schemes::verlet);
  static_cast<void>(tell("verlet", 0.02, Simulation(block.build(), verlet, 0.02)));
  static_cast<void>(tell("verlet", 0.001, Simulation(block.build(), verlet, 0.001)));

  Simulation sim(block.build(), classical(material, method("simo_tarnow_wong")), 0.02);
  auto& energy = sim.every(1, Energy{});
  auto& turning = sim.every(1, AngularMomentum{});
  sim.every(4, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run(400);
  fmt::print("{:17} {:6} {:10.1e} {:10.1e}  {}\n", "simo_tarnow_wong", 0.02, energy.worst(), turning.worst(), outcome);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

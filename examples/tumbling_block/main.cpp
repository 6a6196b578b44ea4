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

const Block bar{.cells = {4, 1, 1},
                .size = {2, 0.5, 0.5},
                .density = 1,
                .stretch = {1.05, 0.97, 1.02},
                .angular_velocity = {0.3, 2, 1}};
const HyperelasticForce steel{{.lambda = 1000, .mu = 800}};

/// One line of the table.
void tell(const char* method, double step, const Outcome& outcome, const Energy& energy,
          const AngularMomentum& turning) {
  fmt::print("{:17} {:6} {:10.1e} {:10.1e}  {} at step {}\n", method, step, energy.worst(), turning.worst(),
             name(outcome.kind), outcome.step);
}

void follow(const char* method, double step, Simulation<double> sim) {
  auto& energy = sim.every(1, Energy{});
  auto& turning = sim.every(1, AngularMomentum{});
  const Outcome outcome = sim.run(400);
  tell(method, step, outcome, energy, turning);
}

int main() {
  Simulation sim(bar.build(), classical(steel, method("simo_tarnow_wong")), 0.02);
  auto& energy = sim.every(1, Energy{});
  auto& turning = sim.every(1, AngularMomentum{});
  sim.every(4, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run(400);
  fmt::print("{}\n", outcome);

  fmt::print("{:17} {:>6} {:>10} {:>10}\n", "method", "step", "energy", "turning");
  for (const char* one : {"implicit_midpoint", "newmark"}) {
    follow(one, 0.02, Simulation(bar.build(), classical(steel, method(one)), 0.02));
  }
  const auto verlet = compose(KineticPotential(steel), schemes::verlet);
  follow("verlet", 0.02, Simulation(bar.build(), verlet, 0.02));
  follow("verlet", 0.001, Simulation(bar.build(), verlet, 0.001));
  tell("simo_tarnow_wong", 0.02, outcome, energy, turning);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

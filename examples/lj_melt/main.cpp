// A Lennard-Jones crystal melts: the benchmark in.lj of LAMMPS, with a cutoff that keeps its energy.
#include "engine/simulation.hpp"
#include "forces/lennard_jones.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/temperature.hpp"
#include "scene/builders.hpp"

#include <fmt/format.h>

using namespace noether;

int main() {
  ParticleSystem atoms = Lattice{.cells = {10, 10, 10}, .density = 0.8442, .mass = 1, .temperature = 1.44}.build();

  const LennardJonesForce pairs{.cutoff = 2.5, .cutoff_style = Cutoff::switch_c4, .epsilon = 1.0, .sigma = 1.0};
  Simulation sim(std::move(atoms), compose(KineticPotential(pairs), schemes::verlet), 0.005);
  auto& energy = sim.every(50, Energy{});
  auto& temperature = sim.every(50, Temperature{});
  sim.every(500, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run(2'000);
  fmt::print("{}: worst energy error {:.1e}, temperature {:.4f}\n", outcome, energy.worst(), temperature.value());
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

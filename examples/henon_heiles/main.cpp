// A particle in the well of Henon and Heiles, its energy and the shadow of its energy.
#include "engine/simulation.hpp"
#include "forces/henon_heiles.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"

#include <fmt/format.h>

using namespace noether;

int main() {
  ParticleSystem star;
  star.add("star", 1, {0, 0.1, 0}, {0.35, 0.05, 0});

  Simulation sim(std::move(star), compose(KineticPotential(HenonHeiles{}), schemes::verlet), 0.1);
  auto& energy = sim.every(1, Energy{});
  auto& shadow = sim.every(1, ShadowHamiltonian{});
  sim.every(10, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run(20'000);
  fmt::print("{}: the energy fluctuates by {:.1e}\n", outcome, energy.rms());
  for (std::size_t k = 0; k < shadow.orders.size(); ++k) {
    fmt::print("  order {:2} of its shadow by {:.1e}\n", shadow.orders[k], shadow.fluctuation(k));
  }
  fmt::print("{}\n{}\n", shadow.verdict(), io::digest(sim.particles()));
  return exit_code(outcome);
}

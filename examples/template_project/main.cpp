#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/digest.hpp"
#include "monitors/monitors.hpp"

#include <fmt/format.h>

using namespace noether;

int main() {
  ParticleSystem bodies;
  bodies.add("star", 1, {0, 0, 0}, {0, 0, 0});
  bodies.add("planet", 0.001, {1, 0, 0}, {0, 1, 0});

  Simulation sim(std::move(bodies), compose(KineticPotential(Gravity{}), schemes::verlet), 0.01);
  auto& energy = sim.every(100, Energy{});
  const Outcome outcome = sim.run(10'000);
  fmt::print("{}: worst energy error {:.1e}\n{}\n", outcome, energy.worst(), io::digest(sim.particles()));
  return exit_code(outcome);
}

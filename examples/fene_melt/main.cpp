// A melt of bead-spring chains in a bath: Kremer and Grest's model, under BAOAB.
#include "engine/simulation.hpp"
#include "forces/bonded.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/langevin.hpp"
#include "integrators/minimize.hpp"
#include "io/digest.hpp"
#include "monitors/monitors.hpp"
#include "monitors/temperature.hpp"
#include "scene/builders.hpp"

#include <fmt/format.h>

using namespace noether;

int main() {
  ParticleSystem beads =
      PolymerChains{.chains = 20, .beads = 50, .density = 0.85, .mass = 1, .temperature = 1.0}.build();
  ForceField<double> forces;
  forces.add(
      LennardJonesForce{.cutoff = 1.122462048309373, .cutoff_style = Cutoff::shifted});  // its minimum: repulsion
  forces.add(Bonded{});

  const Minimized start = minimize(beads, AnyForce<double>(forces), {.max_force = 50});

  auto bath = Langevin(KineticPotential(forces), {.temperature = 1, .friction = 0.5, .seed = 7});
  Simulation sim(std::move(beads), compose(std::move(bath), word("BAOAB")), 0.01);
  auto& energy = sim.every(50, Energy{});
  auto& temperature = sim.every(50, Temperature{});

  const Outcome outcome = sim.run(2'000);
  fmt::print("{}: temperature {:.3f}, energy {:.3f} per bead\n", outcome, temperature.value(), energy.total() / 1'000);
  fmt::print("the start was found in {} steps downhill, to a largest force of {:.1f}\n", start.steps, start.force);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

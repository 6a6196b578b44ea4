// Liquid decane from a LAMMPS data file: brought to a minimum, then kept at 298 K under BAOAB.
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
#include "io/structure.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/pressure.hpp"
#include "monitors/temperature.hpp"
#include "monitors/time_correlation.hpp"
#include "numbers/units.hpp"
#include "scene/builders.hpp"

#include <fmt/format.h>

using namespace noether;
using namespace noether::units::molecular;  // nm, ps, kJ/mol, K

int main() {
  ParticleSystem carbons =
      io::read_structure("decane.data", {.file_units = "real", .mixing = Mixing::lorentz_berthelot});
  set_temperature(carbons, 298 * K, 1);

  ForceField<double> forces;
  forces.add(LennardJonesForce{.cutoff = 1.4 * nm, .cutoff_style = Cutoff::plain, .tail = true});
  forces.add(Bonded{});
  const Minimized start = minimize(carbons, AnyForce<double>(forces), {.max_force = 100 * kJ_per_mol / nm});

  auto bath = Langevin(KineticPotential(forces), {.temperature = 298 * K, .friction = 1 / ps, .seed = 1});
  Simulation sim(std::move(carbons), compose(std::move(bath), word("BAOAB")), 2 * fs);
  auto& energy = sim.every(50, Energy{});
  auto& temperature = sim.every(50, Temperature{});
  auto& pressure = sim.every(50, Pressure{});
  auto& displacement = sim.every(50, MeanSquareDisplacement(100, 10));
  sim.every(500, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run(10'000);
  fmt::print("{}: temperature {:.1f} K, energy {:.2f} kJ/mol per molecule\n", outcome, temperature.value(),
             energy.total() / 64);
  fmt::print("the start was found in {} steps downhill, to a largest force of {:.1f} kJ/mol/nm\n", start.steps,
             start.force);
  fmt::print("mean pressure {:.1f} kJ/mol/nm^3, square displacement {:.3f} nm^2 in {:.3g} ps\n", pressure.mean(),
             displacement.since_start(), sim.time());
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

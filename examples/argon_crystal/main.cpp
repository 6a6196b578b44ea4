// Seven argon atoms, frozen in the plane: the energy error of leapfrog falls by four with half the step.
#include "engine/simulation.hpp"
#include "forces/lennard_jones.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/temperature.hpp"
#include "numbers/units.hpp"

#include <fmt/format.h>

#include <string>

using namespace noether;
using namespace noether::units::molecular;  // nm, ps, u, kJ/mol

int main() {
  const double mass = 66.34e-27 * kg, speed = nm / ns;
  ParticleSystem crystal(unit_system("molecular"));
  crystal.add("center", mass, {0, 0, 0}, {-30 * speed, -20 * speed, 0});
  crystal.add("north", mass, {0.02 * nm, 0.39 * nm, 0}, {50 * speed, -90 * speed, 0});
  crystal.add("northeast", mass, {0.34 * nm, 0.17 * nm, 0}, {-70 * speed, -60 * speed, 0});
  crystal.add("southeast", mass, {0.36 * nm, -0.21 * nm, 0}, {90 * speed, 40 * speed, 0});
  crystal.add("south", mass, {-0.02 * nm, -0.4 * nm, 0}, {80 * speed, 90 * speed, 0});
  crystal.add("southwest", mass, {-0.35 * nm, -0.16 * nm, 0}, {-40 * speed, 100 * speed, 0});
  crystal.add("northwest", mass, {-0.31 * nm, 0.21 * nm, 0}, {-80 * speed, -60 * speed, 0});

  const LennardJonesForce pairs{.cutoff = 10 * nm,  // beyond every pair
                                .cutoff_style = Cutoff::plain,
                                .epsilon = 0.996079 * kJ_per_mol,  // k_B 119.8 K
                                .sigma = 0.341 * nm};
  Outcome outcome;
  std::string digest;
  for (const double step : {80 * fs, 40 * fs}) {
    ParticleSystem atoms = crystal;
    Simulation sim(std::move(atoms), compose(KineticPotential(pairs), schemes::verlet), step);
    auto& energy = sim.every(1, Energy{});
    auto& temperature = sim.every(1, Temperature{});
    sim.every(10, io::TrajectoryWriter{"run.h5"});
    outcome = sim.run_until(40 * ps);
    fmt::print("{}: step {:.0f} fs, energy error {:.1e} rms, {:.1e} at worst\n", outcome, step / fs, energy.rms(),
               energy.worst());
    fmt::print("temperature {:.2f} K rms, drift {:.3f} +- {:.3f} K/ps\n", *temperature.report().rms,
               *temperature.report().slope, *temperature.report().slope_error);
    digest = io::digest(sim.particles());
  }
  fmt::print("{}\n", digest);
  return exit_code(outcome);
}

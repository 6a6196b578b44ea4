// A sodium and a chloride ion in 214 molecules of SPC/E water: they stay together for 10 ps, each in its shell.
#include "constraints/structure_constraints.hpp"
#include "engine/simulation.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/particle_mesh_ewald.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/langevin.hpp"
#include "io/digest.hpp"
#include "io/structure.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/radial_distribution.hpp"
#include "monitors/temperature.hpp"
#include "numbers/units.hpp"
#include "scene/builders.hpp"
#include "scene/constrained.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

using namespace noether;
using namespace noether::units::molecular;  // nm, ps, kJ/mol, K

int main() {
  ParticleSystem brine = io::read_structure("pair.data", {.file_units = "real", .mixing = Mixing::lorentz_berthelot});
  set_temperature(brine, 300 * K, 1);
  const ConstraintSet rigid = rigid_molecules(brine);

  ForceField<double> forces;
  forces.add(LennardJonesForce{.cutoff = 0.9 * nm, .cutoff_style = Cutoff::switch_c4});
  forces.add(ParticleMeshEwald{.cutoff = 0.9 * nm, .relative_error = 1e-4});
  minimize(brine, AnyForce<double>(forces), rigid, {.max_force = 400 * kJ_per_mol / nm});

  const Langevin bath(KineticPotential(forces, rigid), {.temperature = 300 * K, .friction = 2 / ps, .seed = 1});
  Simulation sim(std::move(brine), compose(bath, word("BAOAB")), 2 * fs);
  auto& temperature = sim.every(10, Temperature{});
  sim.every(10, Energy{});
  const Schedule late{.steps = 10, .after = 1 * ps};
  auto& pair = sim.every(late, RadialDistribution(200, {}, {"Na", "Cl"}));
  auto& sodium = sim.every(late, RadialDistribution(200, {}, {"Na", "O"}));
  auto& chloride = sim.every(late, RadialDistribution(200, {}, {"Cl", "O"}));
  sim.every(50, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run(5000);
  fmt::print("{}: temperature {:.0f} K\n", outcome, *temperature.report().rms);
  const auto tell = [](const char* who, const RadialDistribution& seen, double shell) {
    const std::vector<double> g = seen.values(), within = seen.coordination();
    const auto peak = std::max_element(g.begin(), g.end()) - g.begin();
    std::size_t edge = 1;
    while (edge < g.size() && seen.distance(static_cast<std::int64_t>(edge)) < shell) ++edge;
    fmt::print("{}: {:.3f} nm apart most often, {:.1f} within {:.2f} nm\n", who, seen.distance(peak), within[edge - 1],
               shell);
  };
  tell("Cl- about Na+", pair, 0.36 * nm);
  tell("oxygens about Na+", sodium, 0.32 * nm);
  tell("oxygens about Cl-", chloride, 0.38 * nm);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

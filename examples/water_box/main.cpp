// 216 molecules of rigid water, SPC/E: brought to a minimum, then left alone for 6 ps.
#include "constraints/constraint_residual.hpp"
#include "constraints/structure_constraints.hpp"
#include "engine/simulation.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/pair_potentials.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/radial_distribution.hpp"
#include "monitors/temperature.hpp"
#include "numbers/units.hpp"
#include "scene/constrained.hpp"
#include "scene/water_box.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

using namespace noether;
using namespace noether::units::molecular;  // nm, ps, kJ/mol, K

int main() {
  ParticleSystem water =
      WaterBox{
          .model = WaterModel::spce, .molecules = 216, .density = 0.997 * g_per_cm3, .temperature = 175 * K, .seed = 7}
          .build();
  const ConstraintSet rigid = rigid_molecules(water);

  ForceField<double> forces;
  forces.add(LennardJonesForce{.cutoff = 0.9 * nm, .cutoff_style = Cutoff::switch_c4});
  forces.add(ReactionFieldForce{{.radius = 0.9 * nm}});
  const Minimized start = minimize(water, AnyForce<double>(forces), rigid, {.max_force = 400 * kJ_per_mol / nm});

  Simulation sim(std::move(water), compose(KineticPotential(forces, rigid), schemes::verlet), 2 * fs);
  auto& energy = sim.every(10, Energy{});
  auto& temperature = sim.every(10, Temperature{});
  auto& bonds = sim.every(10, ConstraintResidual(rigid));
  auto& oxygens = sim.every(50, RadialDistribution(200, {}, {"O", "O"}));
  sim.every(50, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run(3000);
  const std::vector<double> g = oxygens.values();
  const auto peak = std::max_element(g.begin(), g.end());
  fmt::print("{}: temperature {:.1f} K of {} degrees of freedom\n", outcome, temperature.value(),
             temperature.degrees_of_freedom());
  fmt::print("the start was found in {} steps downhill, to a largest force of {:.1f} kJ/mol/nm\n", start.steps,
             start.force);
  fmt::print("worst relative energy error {:.1e}, drift {:.1e}/ps; worst bond error {:.1e}\n", energy.worst(),
             energy.slope(), bonds.worst());
  fmt::print("oxygens are {:.3f} nm apart most often, g = {:.2f}\n", oxygens.distance(peak - g.begin()), *peak);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

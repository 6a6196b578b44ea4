// 512 molecules of rigid water, SPC/E, with all images of all charges: brought to a minimum, then left alone for 3 ps.
#include "constraints/constraint_residual.hpp"
#include "constraints/structure_constraints.hpp"
#include "engine/simulation.hpp"
#include "forces/lattice_accuracy.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/particle_mesh_ewald.hpp"
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
          .model = WaterModel::spce, .molecules = 512, .density = 0.997 * g_per_cm3, .temperature = 270 * K, .seed = 7}
          .build();
  const ConstraintSet rigid = rigid_molecules(water);

  const ParticleMeshEwald charges{.cutoff = 0.9 * nm, .relative_error = 1e-5};
  ForceField<double> forces;
  forces.add(LennardJonesForce{.cutoff = 0.9 * nm, .cutoff_style = Cutoff::switch_c4});
  forces.add(charges);
  minimize(water, AnyForce<double>(forces), rigid, {.max_force = 400 * kJ_per_mol / nm});
  const LatticeAccuracy accuracy = lattice_accuracy(charges, water).value();

  Simulation sim(std::move(water), compose(KineticPotential(forces, rigid), schemes::verlet), 2 * fs);
  auto& energy = sim.every(10, Energy{});
  auto& temperature = sim.every(10, Temperature{});
  auto& bonds = sim.every(10, ConstraintResidual(rigid));
  auto& oxygens = sim.every(50, RadialDistribution(200, {}, {"O", "O"}));
  sim.every(50, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run(1500);
  const std::vector<double> g = oxygens.values();
  const auto peak = std::max_element(g.begin(), g.end());
  fmt::print("{}: temperature {:.1f} K\n", outcome, temperature.value());
  fmt::print("forces of charges are right to {:.1e}, asked for {:.0e}, by a mesh of {} points along each axis\n",
             accuracy.reached, accuracy.asked, accuracy.mesh[0]);
  fmt::print("worst relative energy error {:.1e}, drift {:.1e}/ps; worst bond error {:.1e}\n", energy.worst(),
             energy.slope(), bonds.worst());
  fmt::print("oxygens are {:.3f} nm apart most often, g = {:.2f}\n", oxygens.distance(peak - g.begin()), *peak);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

// A crystal of 512 ions, Na+ and Cl-: its lattice has Madelung's energy, and half of its heat goes into the potential.
#include "engine/charge.hpp"
#include "engine/simulation.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/particle_mesh_ewald.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/radial_distribution.hpp"
#include "monitors/temperature.hpp"
#include "numbers/units.hpp"
#include "scene/ionic_crystal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

using namespace noether;
using namespace noether::units::molecular;  // nm, ps, kJ/mol, K, e

int main() {
  const double constant = 0.564 * nm, madelung = 1.7475645946331822;
  ParticleSystem salt = IonicCrystal{.lattice = IonicLattice::rock_salt,
                                     .cells = {4, 4, 4},
                                     .ions = {"Na", "Cl"},
                                     .masses = {22.98977 * u, 35.453 * u},
                                     .charge = 1 * e,
                                     .constant = constant,
                                     .epsilon = {1.4754533 * kJ_per_mol, 0.05349244 * kJ_per_mol},
                                     .sigma = {0.2159538 * nm, 0.4830453 * nm},
                                     .temperature = 600 * K,
                                     .seed = 1}
                            .build();

  const ParticleMeshEwald charges{.cutoff = 0.9 * nm, .relative_error = 1e-6};
  ForceField<double> forces;
  forces.add(LennardJonesForce{.cutoff = 0.9 * nm, .cutoff_style = Cutoff::switch_c4, .tail = true});
  forces.add(charges);

  VectorColumn<double> a(salt.size());
  ForceSink<double> lattice(a, salt, {.energy = true});
  charges.add_to(lattice, salt);

  Simulation sim(std::move(salt), compose(KineticPotential(forces), schemes::verlet), 2 * fs);
  auto& energy = sim.every(10, Energy{});
  auto& temperature = sim.every(10, Temperature{});
  auto& neighbors = sim.every(50, RadialDistribution(200, {}, {"Na", "Cl"}));
  sim.every(50, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run(2000);
  const std::vector<double> g = neighbors.values();
  const auto peak = std::max_element(g.begin(), g.end());
  fmt::print("{}: temperature {:.1f} K on the average, worst relative energy error {:.1e}\n", outcome,
             *temperature.report().rms, energy.worst());
  fmt::print("charges: {:.6f} kJ/mol for each pair of ions, by Madelung's constant {:.6f}\n",
             lattice.potential() / 256 / kJ_per_mol, -madelung * coulomb_constant / (constant / 2) / kJ_per_mol);
  fmt::print("Na+ and Cl- are {:.3f} nm apart most often, g = {:.1f}\n", neighbors.distance(peak - g.begin()), *peak);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

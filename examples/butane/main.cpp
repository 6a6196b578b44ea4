// 64 molecules of butane with rigid bonds, which do not feel each other, in a bath: how many are trans, and how many
// must be.
#include "constraints/constraint_residual.hpp"
#include "constraints/constraint_solver.hpp"
#include "constraints/structure_constraints.hpp"
#include "engine/simulation.hpp"
#include "forces/bonded.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/langevin.hpp"
#include "io/digest.hpp"
#include "io/structure.hpp"
#include "io/trajectory.hpp"
#include "monitors/dihedrals.hpp"
#include "monitors/temperature.hpp"
#include "numbers/units.hpp"
#include "scene/builders.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

using namespace noether;
using namespace noether::units::molecular;  // nm, ps, kJ/mol, K

/// The torsion of TraPPE over k_B [K].
double torsion(double phi) {
  return 355.03 * (1 + std::cos(phi)) - 68.19 * (1 - std::cos(2 * phi)) + 791.32 * (1 + std::cos(3 * phi));
}

/// The fraction trans, |phi| > 120 degrees, that Boltzmann's distribution of the torsion alone has: exact for rigid
/// bonds and angles that bend. The midpoint rule.
double trans_of_boltzmann(double temperature) {
  constexpr int points = 3000;
  double all = 0, trans = 0;
  for (int k = 0; k < points; ++k) {
    const double phi = (k + 0.5) / points * std::numbers::pi, weight = std::exp(-torsion(phi) / temperature);
    all += weight;
    if (3 * phi > 2 * std::numbers::pi) trans += weight;
  }
  return trans / all;
}

int main() {
  ParticleSystem carbons = io::read_structure("butane.data", {.file_units = "real"});
  set_temperature(carbons, 400 * K, 1);
  const ConstraintSet rigid = bonds(carbons);
  leave_out_rigid_terms(carbons, rigid);

  auto bath = Langevin(KineticPotential(Bonded{}, rigid), {.temperature = 400 * K, .friction = 2 / ps, .seed = 1});
  Simulation sim(std::move(carbons), compose(std::move(bath), word("BAOAB")), 4 * fs);
  auto& temperature = sim.every(100, Temperature{});
  auto& residual = sim.every(100, ConstraintResidual(rigid));
  auto& angles = sim.every(25, Dihedrals(72));
  sim.every(2500, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run(200'000);
  const auto [trans, gauche_plus, gauche_minus] = angles.fractions();
  fmt::print("{}: temperature {:.0f} K, worst bond error {:.1e}\n", outcome, temperature.value(), residual.worst());
  fmt::print("gauche: {:.4f} on one side, {:.4f} on the other, errors {:.4f} and {:.4f}\n", gauche_plus, gauche_minus,
             angles.fraction_errors()[1], angles.fraction_errors()[2]);
  fmt::print("trans: {:.4f} +- {:.4f}; of Boltzmann's distribution {:.4f}\n", trans, angles.fraction_errors()[0],
             trans_of_boltzmann(400));
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

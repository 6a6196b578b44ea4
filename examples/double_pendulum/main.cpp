// A pendulum that hangs on a pendulum.
#include "constraints/constraint_residual.hpp"
#include "constraints/constraint_solver.hpp"
#include "constraints/distance.hpp"
#include "constraints/surfaces.hpp"
#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"

#include <fmt/format.h>

#include <numbers>

using namespace noether;

int main() {
  using std::numbers::pi, std::numbers::sqrt2;
  // Angles from straight down: pi/4, at rest, and pi/2, turning by pi/8 a second.
  ParticleSystem bobs(unit_system("si"));
  bobs.add("upper", 1, {sqrt2, -sqrt2, 0}, {0, 0, 0});
  bobs.add("lower", 2, {sqrt2 + 3, -sqrt2, 0}, {0, 3 * pi / 8, 0});

  ConstraintSet rods;
  rods.add(bobs, OnSphere{.radius = 2}, {0});
  rods.add(bobs, Distance{.length = 3}, {0, 1});
  const KineticPotential swing(UniformField{{0, -9.80665, 0}}, rods);
  Simulation sim(std::move(bobs), compose(swing, schemes::kahan_li_6_s9), 0.01);
  auto& energy = sim.every(1, Energy{});
  auto& shadow = sim.every(1, ShadowHamiltonian{});
  auto& residual = sim.every(1, ConstraintResidual{rods});
  sim.every(4, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run_until(100);
  fmt::print("{}: worst energy error {:.1e}, rods within {:.0e}\n", outcome, energy.worst(), residual.worst());
  fmt::print("{}\n", shadow.verdict());
  const Vec3<double> x = sim.particles().positions()[1];
  fmt::print("the lower bob ends at ({:.6f}, {:.6f})\n", x[0], x[1]);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

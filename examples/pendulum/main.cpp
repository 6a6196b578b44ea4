// A pendulum that swings far out, and when it should come back.
#include "constraints/constraint_residual.hpp"
#include "constraints/constraint_solver.hpp"
#include "constraints/surfaces.hpp"
#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"

#include <fmt/format.h>

#include <cmath>

using namespace noether;

int main() {
  const double length = 1, g = 9.80665;
  ParticleSystem pendulum(unit_system("si"));
  pendulum.add("bob", 1, {0.8, 0.6, 0}, {0, 0, 0});  // above its pivot, the origin

  ConstraintSet rod;
  rod.add(pendulum, OnSphere{.radius = length}, {0});
  const KineticPotential swing(UniformField{{0, -g, 0}}, rod);
  Simulation sim(std::move(pendulum), compose(swing, schemes::kahan_li_6_s9), 0.02);
  auto& energy = sim.every(1, Energy{});
  auto& residual = sim.every(1, ConstraintResidual{rod});
  sim.every(1, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run_until(100);
  fmt::print("{}: worst energy error {:.1e}, rod within {:.0e}\n", outcome, energy.worst(), residual.worst());

  // sin(angle/2) = k sin(phi), d(angle)/dt = 2 k sqrt(g/l) cos(phi): a quarter of the period takes sqrt(l/g) K(k).
  const double tau = std::sqrt(length / g), k = std::sqrt(0.8);  // k^2 = (1 + 0.6) / 2
  const double period = 4 * tau * std::comp_ellint_1(k);
  const Vec3<double> x = sim.particles().positions()[0], v = sim.particles().velocities()[0];
  const double angle = std::atan2(x[0], -x[1]), turning = (x[0] * v[1] - x[1] * v[0]) / (length * length);
  const double phi = std::atan2(std::sin(angle / 2), turning * tau / 2);
  const double early = -std::remainder(period / 4 + sim.time() - tau * std::ellint_1(k, phi), period);
  fmt::print("period {:.9f} s by the elliptic integral; after {:.0f} of them early by {:.1e} s\n", period,
             std::floor(sim.time() / period), early);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

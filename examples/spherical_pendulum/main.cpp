// A pendulum that goes round as well as up and down: its energy, the shadow of its energy, its angular momentum.
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
#include "monitors/shadow_hamiltonian.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

using namespace noether;

/// A monitor of this program's own: how far the angular momentum about the vertical has been from its start.
struct Spin {
  std::optional<double> first;
  double worst = 0;

  void observe(const Snapshot<double>& now) {
    const Vec3<double> x = now.state().positions()[0], v = now.state().velocities()[0];
    const double spin = now.state().masses()[0] * (x[0] * v[1] - x[1] * v[0]);
    if (!first) first = spin;
    worst = std::max(worst, std::abs(spin / *first - 1));
  }
};

int main() {
  ParticleSystem pendulum(unit_system("si"));
  pendulum.add("bob", 1, {0.8, 0, -0.6}, {0, 1.5, 0});  // about the vertical through its pivot, the origin

  ConstraintSet rod;
  rod.add(pendulum, OnSphere{.radius = 1}, {0});
  const KineticPotential swing(UniformField{{0, 0, -9.80665}}, rod);
  Simulation sim(std::move(pendulum), compose(swing, schemes::verlet), 0.01);
  auto& energy = sim.every(1, Energy{});
  auto& shadow = sim.every(1, ShadowHamiltonian{});
  auto& spin = sim.every(1, Spin{});
  sim.every(5, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run_until(100);
  fmt::print("{}: the energy fluctuates by {:.1e}\n", outcome, energy.rms());
  for (std::size_t k = 0; k < shadow.orders.size(); ++k) {
    fmt::print("  order {:2} of its shadow by {:.1e}\n", shadow.orders[k], shadow.fluctuation(k));
  }
  fmt::print("{}\n", shadow.verdict());
  fmt::print("angular momentum about the vertical {:.1f}, worst error {:.1e}\n", *spin.first, spin.worst);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

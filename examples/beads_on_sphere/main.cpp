// Two beads on a sphere attract each other: a force the user wrote, on a constraint.
#include "examples/beads_on_sphere/sphere_attraction.hpp"

#include "constraints/constraint_residual.hpp"
#include "constraints/constraint_solver.hpp"
#include "constraints/surfaces.hpp"
#include "engine/simulation.hpp"
#include "forces/check_gradient.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/bodies.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"

#include <fmt/format.h>

using namespace noether;

int main() {
  ParticleSystem beads = io::read_bodies("beads.csv", {.units = &unit_system("reduced")});
  check_gradient(SphereAttraction{}, beads);  // throws if a is not -grad U / m

  ConstraintSet sphere;
  for (const Index bead : {0, 1}) sphere.add(beads, OnSphere{.radius = 1}, {bead});
  Simulation sim(std::move(beads), compose(KineticPotential(SphereAttraction{}, sphere), schemes::verlet), 0.02);
  auto& energy = sim.every(1, Energy{});
  auto& angular_momentum = sim.every(1, AngularMomentum{});
  auto& residual = sim.every(1, ConstraintResidual{sphere});
  sim.every(1, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run_until(10);
  fmt::print("{}: energy {:.9f}, worst error {:.1e}\n", outcome, energy.total(), energy.worst());
  fmt::print("worst angular momentum error {:.1e}, on the sphere within {:.0e}\n", angular_momentum.worst(),
             residual.worst());
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

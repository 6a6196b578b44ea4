// Beads on a wire that is bent to a cycloid: a constraint the user wrote, in a program.
#include "examples/bead_on_wire/cycloid.hpp"

#include "constraints/constraint_residual.hpp"
#include "constraints/constraint_solver.hpp"
#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/bodies.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

using namespace noether;

int main() {
  ParticleSystem beads = io::read_bodies("beads.csv", {.units = &unit_system("si")});
  const ParticleSystem start = beads;
  const OnCycloid cycloid{.radius = 0.5};
  const double g = 9.80665, omega = std::sqrt(g / (4 * cycloid.radius));

  ConstraintSet wire;
  for (Index i = 0; i < beads.size(); ++i) wire.add(beads, cycloid, {i});
  const KineticPotential slide(UniformField{{0, -g, 0}}, wire);
  Simulation sim(std::move(beads), compose(slide, schemes::kahan_li_6_s9), 0.05);
  auto& energy = sim.every(1, Energy{});
  auto& residual = sim.every(1, ConstraintResidual{wire});
  sim.every(1, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run_until(10);
  fmt::print("{}: worst energy error {:.1e}, wire within {:.0e}\n", outcome, energy.worst(), residual.worst());
  fmt::print("period of all beads {:.6f} s\n", 2 * std::numbers::pi / omega);
  for (Index i = 0; i < start.size(); ++i) {
    // The way along the wire from its lowest point, s = 4 R sin(u/2), swings as s0 cos(omega t).
    const auto way = [&](const Vec3<double>& x) { return std::copysign(std::sqrt(8 * cycloid.radius * x[1]), x[0]); };
    const double exact = way(start.positions()[i]) * std::cos(omega * sim.time());
    fmt::print("{} at {:.6f} m along the wire, {:.1e} from where it should be\n", start.name(i), exact,
               way(sim.particles().positions()[i]) - exact);
  }
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

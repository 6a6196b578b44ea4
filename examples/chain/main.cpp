// A chain of a hundred links, held out straight and let go.
#include "constraints/constraint_residual.hpp"
#include "constraints/constraint_solver.hpp"
#include "constraints/distance.hpp"
#include "constraints/surfaces.hpp"
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

using namespace noether;

/// A monitor of this program's own: how fast the free end is, and when.
struct Whip {
  double speed = 0, time = 0;

  void observe(const Snapshot<double>& now) {
    const auto& v = now.state().velocities();
    const double end = std::sqrt(norm2(Vec3<double>(v[v.size() - 1])));
    if (end <= speed) return;
    speed = end;
    time = now.time();
  }
};

int main() {
  ParticleSystem chain = io::read_bodies("links.csv", {.units = &unit_system("si")});
  const Index last = chain.size() - 1;

  ConstraintSet links;
  links.add(chain, Fixed{}, {0});
  for (Index i = 1; i <= last; ++i) links.add(chain, Distance{.length = 0.1}, {i - 1, i});
  const KineticPotential fall(UniformField{{0, -9.80665, 0}}, links);
  Simulation sim(std::move(chain), compose(fall, schemes::verlet), 0.001);
  auto& energy = sim.every(1, Energy{});
  auto& residual = sim.every(1, ConstraintResidual{links});
  auto& whip = sim.every(1, Whip{});
  sim.every(20, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run_until(4);
  fmt::print("{}: worst energy error {:.1e}, links within {:.0e}\n", outcome, energy.worst(), residual.worst());
  const Vec3<double> end = sim.particles().positions()[last];
  fmt::print("its end was fastest at {:.3f} s, with {:.3f} m/s, and stops at ({:.4f}, {:.4f})\n", whip.time, whip.speed,
             end[0], end[1]);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

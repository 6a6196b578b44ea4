// A top that turns fast enough stays upright: omega^2 > 4 m g l I_1/I_3^2. Here that is 4.
#include "engine/bodies.hpp"
#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/on_sites.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/rotating.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

using namespace noether;

/// How far each top has leaned.
struct Lean {
  std::array<double, 2> most{};

  void observe(const Snapshot<double>& now) {
    for (Index i = 0; i < 2; ++i) {
      const Mat3<double> r = rotation_matrix<double>(now.state().column<BodyOrientation>()[i]);
      const double lean = std::atan2(std::hypot(r(0, 2), r(1, 2)), r(2, 2));
      most[static_cast<std::size_t>(i)] = std::max(most[static_cast<std::size_t>(i)], lean);
    }
  }
};

int main() {
  ParticleSystem<double> s(unit_system("reduced"));
  const Quaternion<double> upright(std::cos(1e-6 / 2), std::sin(1e-6 / 2), 0, 0);
  add_body(s, top("sleeper", 2, {1, 1, 0.5}, {0, 0, 0.5}),
           {.orientation = upright, .angular_velocity = Vec3<double>(0, 0, 4.1)});
  add_body(s, top("waker", 2, {1, 1, 0.5}, {0, 0, 0.5}),
           {.x = {4, 0, 0}, .orientation = upright, .angular_velocity = Vec3<double>(0, 0, 3.9)});
  ForceField<double> on_tops, on_sites;
  on_sites.add(UniformField{{0, 0, -1}});
  on_tops.add(OnSites<double>(on_sites));
  Simulation sim(std::move(s),
                 compose(Rotating<AnyHamiltonian<double>>(KineticPotential(on_tops)), *schemes::find("srkn11b")), 0.05);
  auto& energy = sim.every(1, Energy{});
  auto& lean = sim.every(1, Lean{});
  sim.every(2, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run_until(100);
  fmt::print("{}: energy within {:.1e}\n", outcome, energy.worst());
  fmt::print("at a rate of 4.1 a lean of 1e-6 becomes {:.1e}, at one of 3.9 it becomes {:.3f}\n", lean.most[0],
             lean.most[1]);
  // Where it turns round, the closed form has u = cos theta with 2 (1 + u) = a^2, a = I_3 omega.
  fmt::print("where it turns back by its conserved quantities: {:.3f}\n", std::acos(0.5 * 0.5 * 3.9 * 3.9 / 2 - 1));
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

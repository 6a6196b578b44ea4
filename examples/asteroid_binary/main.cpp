// The two halves of asteroid 1999 KW4 for a year: a fast oblate one, and a long one that librates as it goes round.
#include "engine/bodies.hpp"
#include "engine/given_orbit.hpp"
#include "engine/simulation.hpp"
#include "forces/gravity_of_bodies.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/rotating.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/orbital_monitors.hpp"
#include "monitors/spin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace noether;

/// The largest angle between Beta's long axis and the line to Alpha, along the orbit.
struct Libration {
  double most = 0;

  void observe(const Snapshot<double>& now) {
    const ParticleSystem<double>& s = now.state();
    const Vec3<double> line = s.positions()[0] - s.positions()[1];
    const Vec3<double> axis = rotation_matrix<double>(s.column<BodyOrientation>()[1]).col(0);
    const double along = dot(axis, line), across = std::sqrt(norm2(cross<double>(axis, line)));
    most = std::max(most, std::atan2(across, std::abs(along)));
  }
};

int main() {
  const UnitSystem& si = unit_system("si");
  const double km = 1000, hour = 3600, pi = std::acos(-1.0);
  ParticleSystem<double> rocks(si);
  const RigidBody alpha = ellipsoid("Alpha", 2.353e12, {0.766 * km, 0.748 * km, 0.674 * km});
  const RigidBody beta = ellipsoid("Beta", 1.35e11, {0.285 * km, 0.232 * km, 0.175 * km});
  add_body(rocks, alpha, {.spin_period = 2.7645 * hour});
  const auto [x, v] = state_of_orbit({.a = 2.548 * km, .e = 0.01}, si.G * (alpha.mass + beta.mass));
  add_body(rocks, beta, {.x = x, .v = v, .spin_period = 17.4 * hour});
  move_to_barycenter(rocks);

  Simulation sim(
      std::move(rocks),
      compose(Rotating<AnyHamiltonian<double>>(KineticPotential(GravityOfBodies{})), *schemes::find("srkn14a")),
      0.2 * hour);
  auto& energy = sim.every(10, Energy{});
  auto& momentum = sim.every(10, AngularMomentum{});
  auto& spin = sim.every(10, Spin{"Beta"});
  auto& elements = sim.every(10, Elements{});
  auto& libration = sim.every(10, Libration{});
  sim.every(30, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run_until(365.25 * 24 * hour);

  fmt::print("{}: energy within {:.1e}, angular momentum within {:.1e}\n", outcome, energy.worst(),
             *momentum.report().worst);
  fmt::print("Beta looks away from Alpha by at most {:.2f} degrees\n", libration.most * 180 / pi);
  fmt::print("its orbit now: a = {:.4f} km, e = {:.4f}; it turns once in {:.3f} h\n", elements.of(1).a / km,
             elements.of(1).e, 2 * pi / std::abs(spin.rate()[2]) / hour);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

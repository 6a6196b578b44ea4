// Two charges under Weber's electrodynamics: their ellipse turns, and like charges have a distance at which they end.
#include "engine/simulation.hpp"
#include "integrators/systems/weber.hpp"
#include "integrators/variational/lagrangian_system.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

using namespace noether;

namespace {

// Masses of 2, charges of 1 and -1, c = 5: apart by 1, with a relative velocity of 0.8 across.
const Weber pair{};

struct Apart {
  double x, y, along;
};

// Where one is from the other, and r r' of the momenta.
Apart apart(const std::vector<double>& y) {
  const double x = y[0] - y[3], z = y[1] - y[4];
  return {x, z, x * (y[6] - y[9]) + z * (y[7] - y[10])};
}

}  // namespace

int main() {
  Simulation sim(initial_state(pair), variational(pair, method("galerkin_gauss_3")), 0.05);
  auto& energy = sim.every(1, Energy{});
  sim.every(1, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run(1600);
  fmt::print("{}\nenergy within {:.0e}\n{}\n", outcome, energy.worst(), io::digest(sim.particles()));
  if (!outcome.ok()) return exit_code(outcome);

  // Apocenters, where the distance stops growing.
  Simulation turning(initial_state(pair), variational(pair, method("galerkin_gauss_3")), 0.01);
  double first_time = 0, last_time = 0, first_angle = 0, last_angle = 0;
  int apocenters = 0;
  Apart before = apart(turning.particles().variables());
  while (apocenters < 11 && turning.run(1).ok()) {
    const Apart now = apart(turning.particles().variables());
    if (before.along > 0 && now.along <= 0) {
      const double part = before.along / (before.along - now.along);
      last_time = turning.time() - 0.01 * (1 - part);
      last_angle = std::atan2(before.y + part * (now.y - before.y), before.x + part * (now.x - before.x));
      if (apocenters++ == 0) {
        first_time = last_time;
        first_angle = last_angle;
      }
    }
    before = now;
  }
  const double turned = std::remainder(last_angle - first_angle, 2 * std::numbers::pi) / (apocenters - 1);
  fmt::print("a radial period of {:.5f}, where the quadrature has 4.06784\n",
             (last_time - first_time) / (apocenters - 1));
  fmt::print("the ellipse turns by {:.5f} in each, where elliptic integrals have 0.19319\n", turned);

  // Like charges head-on turn where the energy is k/r, or meet the distance at which their reduced mass vanishes.
  for (const double speed : {1.0, 3.0}) {
    const Weber head_on{.charges = {1, 1},
                        .positions = {2.5, 0, 0, -2.5, 0, 0},
                        .velocities = {-speed / 2, 0, 0, speed / 2, 0, 0},
                        .c = 2};
    Simulation meeting(initial_state(head_on), variational(head_on, method("galerkin_gauss_3")), 0.01);
    double nearest = 5;
    Outcome end;
    while (meeting.time() < 8 && end.ok()) {
      end = meeting.run(1);
      const std::vector<double>& y = meeting.particles().variables();
      nearest = std::min(nearest, y[0] - y[3]);
    }
    fmt::print("like charges at {:.1f}: nearest at {:.4f}; {}\n", speed, nearest, end.ok() ? "they turn" : "they end");
  }
  return 0;
}

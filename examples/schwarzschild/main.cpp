// A body that falls about a black hole on an orbit that zooms out and whirls: how well do methods keep it at equal
// steps?
#include "engine/simulation.hpp"
#include "integrators/classical.hpp"
#include "integrators/hamiltonian_system.hpp"
#include "integrators/systems/schwarzschild.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

using namespace noether;

namespace {

// A little below the top of the potential of L = 3.6, at r = 4.72, where it could circle for ever.
const Schwarzschild hole{.mass = 1, .r = 13.15, .p_r = 0, .angular_momentum = 3.6};

MethodChoice by(const std::string& name) {
  MethodOptions options;
  if (name.starts_with("gauss")) options.adaptive = false;
  return method(name, options);
}

// r and phi after a proper time of 600.
std::array<double, 2> end_of(const std::string& name, double step) {
  Simulation sim(initial_state(hole), classical(hole, by(name)), step);
  if (!sim.run_until(600).ok()) return {std::nan(""), std::nan("")};
  const std::vector<double>& y = sim.particles().variables();
  return {y[1], y[2]};
}

// Turns between two apocenters.
double turns_an_orbit() {
  Simulation sim(initial_state(hole), classical(hole, by("semiexplicit_4")), 0.1);
  double before = 0, angle = 0, p = 0;
  int orbits = 0;
  while (orbits < 4 && sim.run(1).ok()) {
    const std::vector<double>& y = sim.particles().variables();
    if (p > 0 && y[4] <= 0) {  // between the last two steps
      angle = before + (y[2] - before) * p / (p - y[4]);
      ++orbits;
    }
    before = y[2];
    p = y[4];
  }
  return angle / (2 * std::numbers::pi * orbits);
}

}  // namespace

int main() {
  Simulation sim(initial_state(hole), classical(hole, by("semiexplicit_4")), 0.25);
  auto& energy = sim.every(4, Energy{});
  sim.every(4, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run(12'000);
  fmt::print("{}\nH within {:.1e}\n{}\n", outcome, energy.worst(), io::digest(sim.particles()));
  if (!outcome.ok()) return exit_code(outcome);
  fmt::print("{:.3f} turns from one apocenter to the next\n", turns_an_orbit());
  const std::array<double, 2> exact = end_of("gauss_8", 0.05);
  for (const char* name : {"semiexplicit_2", "semiexplicit_4", "semiexplicit_6", "tao_4", "gauss_2", "rk4"}) {
    const std::array<double, 2> end = end_of(name, 0.25);
    fmt::print("{:<15} r off by {:.1e}, phi by {:.1e} after a proper time of 600\n", name, std::abs(end[0] - exact[0]),
               std::abs(end[1] - exact[1]));
  }
  return 0;
}

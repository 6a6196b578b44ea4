// A pendulum from nothing but its Lagrangian, and from a discrete Lagrangian.
#include "examples/pendulum_by_its_action/action.hpp"

#include "engine/simulation.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"

#include <fmt/format.h>

using namespace noether;

/// By steps of a method over the Lagrangian, from theta = 2 and p = 0.3.
Outcome swing(const std::string& path, const MethodChoice& method, double step, const std::string& file) {
  Simulation sim(initial_state(Pendulum{}, {2.0}, {0.3}), variational(Pendulum{}, method), step);
  auto& energy = sim.every(1, Energy{});
  auto& shadow = sim.every(1, ShadowHamiltonian{});
  sim.every(1, io::TrajectoryWriter{file});
  const Outcome outcome = sim.run_until(60);
  fmt::print("{}\n", outcome);
  fmt::print("{}: energy within {:.1e}; its shadow: {}\n", path, energy.worst(), shadow.verdict());
  fmt::print("{}\n", io::digest(sim.particles()));
  return outcome;
}

int main() {
  const Outcome cubic = swing("cubic path", method("galerkin_gauss_3"), 0.25, "run.h5");
  if (!cubic.ok()) return exit_code(cubic);
  return exit_code(swing("straight path", Variational{StraightPath{}}, 0.1, "straight.h5"));
}

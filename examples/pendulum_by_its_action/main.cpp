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
  fmt::print("{}: {}, energy within {:.1e}\n", path, outcome, energy.worst());
  fmt::print("  its shadow: {}\n{}\n", shadow.verdict(), io::digest(sim.particles()));
  return outcome;
}

int main() {
  const Outcome own = swing("straight path", Variational{StraightPath{}}, 0.1, "straight.h5");
  if (!own.ok()) return exit_code(own);
  return exit_code(swing("cubic path", method("galerkin_gauss_3"), 0.25, "run.h5"));
}

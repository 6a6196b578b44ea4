// Heat on a line: what a finer line costs an explicit method, and what it costs a stiff one.
#include "engine/simulation.hpp"
#include "integrators/first_order_system.hpp"
#include "integrators/systems/heat_line.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/variables.hpp"

#include <fmt/format.h>

#include <cmath>

using namespace noether;

namespace {

constexpr double end = 0.2;

Simulation<double> heat(const HeatLine& line, const char* name) {
  return Simulation(initial_state(line), classical(line, method(name, {.rtol = 1e-6, .atol = 1e-9})));
}

/// Steps that a method needs to the end.
std::int64_t steps_of(const HeatLine& line, const char* name) {
  Simulation<double> sim = heat(line, name);
  return sim.run_until(end).step;
}

}  // namespace

int main() {
  fmt::print("points     S = max |lambda| T   dop853 steps   rodas_5p steps\n");
  for (const std::int64_t points : {25, 50, 100, 200}) {
    const HeatLine line{.points = points};
    fmt::print("{:<10} {:<20.4g} {:<14} {}\n", points, line.rate_of(points) * end, steps_of(line, "dop853"),
               steps_of(line, "rodas_5p"));
  }

  const HeatLine line{.points = 100, .left = 1, .mode = 2};
  Simulation<double> sim = heat(line, "rodas_5p");
  sim.every_time(0.01, Variables{"y[24]"});
  sim.every_time(0.01, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run_until(end);

  const std::vector<double> exact = line.exact(end);
  double error = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    error = std::max(error, std::abs(sim.particles().variables()[i] - exact[i]));
  }
  fmt::print("{}: error {:.1e}\n", outcome, error);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

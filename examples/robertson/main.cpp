// Kinetics over eleven decades of time, by a stiff method; the system is a struct of this example.
#include "examples/robertson/kinetics.hpp"

#include "engine/simulation.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/variables.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

using namespace noether;

int main() {
  const Kinetics kinetics;
  Simulation sim(initial_state(kinetics), classical(kinetics, method("rodas_5p", {.rtol = 1e-8, .atol = 1e-16})));
  sim.every(10, Variables{"C"});
  sim.every(10, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run_until(1e11);

  // MazziaMagherini2008, at time 1e11.
  constexpr std::array published = {0.2083340149701255e-07, 0.8333360770334713e-13, 0.9999999791665050};
  fmt::print("{}, {} evaluations\n", outcome, sim.evaluations().force);
  const ParticleSystem<double>& end = sim.particles();
  for (Index i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    fmt::print("{} = {:.6e}, off by {:.0e} of the published value\n", end.variable_name(i), end.variables()[k],
               std::abs(end.variables()[k] / published[k] - 1));
  }
  fmt::print("{}\n", io::digest(end));
  return exit_code(outcome);
}

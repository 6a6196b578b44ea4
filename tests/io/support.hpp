#pragma once
/// What the tests of files share: errors in a line, a run that writes.

#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/first_order_system.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/systems/lorenz.hpp"
#include "io/checkpoint.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/process.hpp"

#include <filesystem>
#include <string>
#include <utility>

namespace noether::test {

/// What a call throws, in one line; "" if nothing.
template <class Call> std::string error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// The outer planets under Verlet, steps of 40 days, writing frames every 5 steps and the energy every 3.
struct WritingRun {
  explicit WritingRun(const std::filesystem::path& file, ParticleSystem<double> particles = outer_planets(),
                      const AnyIntegrator<double>& integrator = compose(kinetic_potential(Gravity{.G = outer_G}),
                                                                        schemes::verlet))
      : simulation(std::move(particles), integrator, 40.0),
        energy(&simulation.every(3, Energy{})),
        angular(&simulation.every(10, AngularMomentum{})),
        writer(&simulation.every(5, io::TrajectoryWriter(file, {.scene_toml = "title = \"outer planets\"\n"}))) {}

  Simulation<double> simulation;
  Energy* energy;
  AngularMomentum* angular;
  io::TrajectoryWriter* writer;
};

/// Lorenz's system under RK4, frames every 5 steps.
struct LorenzRun {
  explicit LorenzRun(const std::filesystem::path& file,
                     io::TrajectoryOptions options = {.scene_toml = "title = \"l\"\n"})
      : simulation(initial_state(Lorenz{}), classical(Lorenz{}, method("rk4")), 0.25e-2),
        writer(&simulation.every(5, io::TrajectoryWriter(file, std::move(options)))) {}

  Simulation<double> simulation;
  io::TrajectoryWriter* writer;
};

}  // namespace noether::test

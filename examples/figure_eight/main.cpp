// Three equal masses chase each other along one figure eight.
#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/orbital_monitors.hpp"

#include <fmt/format.h>

#include <cmath>

using namespace noether;

int main() {
  ParticleSystem bodies;
  bodies.add("red", 1, {0.97000436, -0.24308753, 0}, {0.466203685, 0.43236573, 0});
  bodies.add("green", 1, {-0.97000436, 0.24308753, 0}, {0.466203685, 0.43236573, 0});
  bodies.add("blue", 1, {0, 0, 0}, {-0.93240737, -0.86473146, 0});
  const Vec3<double> start = bodies.positions()[0];

  // 400 steps are one period, 6.32591398.
  Simulation sim(std::move(bodies), compose(KineticPotential(Gravity{}), schemes::srkn14a), 0.01581478495);
  auto& energy = sim.every(10, Energy{});
  auto& closest = sim.every(10, ClosestApproach{});
  sim.every(10, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run(4'000);
  const Vec3<double> end = sim.particles().positions()[0];
  fmt::print("{}: worst energy error {:.1e}\n", outcome, energy.worst());
  fmt::print("after ten periods {:.1e} from the start, closest approach {:.6f}\n", std::sqrt(norm2(end - start)),
             closest.distance());
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

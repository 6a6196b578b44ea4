// A Kepler orbit of eccentricity 0.9 for ten periods: does the planet come back to where it was?
#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"

#include <fmt/format.h>

#include <cmath>

using namespace noether;

int main() {
  // a = 1 and G (m0 + m1) = 1, so the period is 2 pi; at the pericenter r = 1 - e and v = sqrt((1 + e)/(1 - e)).
  ParticleSystem bodies;
  bodies.add("star", 0.75, {0, 0, 0}, {0, 0, 0});
  bodies.add("planet", 0.25, {0.1, 0, 0}, {0, 4.358898943540674, 0});
  move_to_barycenter(bodies);
  const Vec3<double> start = bodies.positions()[1];

  // A thousandth of the period.
  Simulation sim(std::move(bodies), compose(KineticPotential(Gravity{}), schemes::yoshida_8), 0.006283185307179587);
  auto& energy = sim.every(10, Energy{});
  auto& angular_momentum = sim.every(10, AngularMomentum{});
  sim.every(10, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run(10'000);
  const Vec3<double> end = sim.particles().positions()[1];
  fmt::print("{}: worst energy error {:.1e}\n", outcome, energy.worst());
  fmt::print("worst angular momentum error {:.1e}\n", angular_momentum.worst());
  fmt::print("after ten periods {:.1e} from the start\n", std::sqrt(norm2(end - start)));
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

// A spring, friction and a periodic push: after a while the bob follows the push.
#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/linear_drag.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/damped.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"

#include <fmt/format.h>

#include <cmath>

using namespace noether;

int main() {
  ParticleSystem system;
  system.add("bob", 1, {1, 0, 0}, {0, 0, 0});

  const OscillatingField push{.acceleration = {0.5, 0, 0}, .omega = 0.75};
  const LinearDrag friction{.rate = 0.125};
  const KineticPotential forces(Sum(HarmonicField{.k = 1}, push));
  Simulation sim(std::move(system), compose(Damped(forces, friction), schemes::verlet), 0.01);
  auto& energy = sim.every(100, Energy{});
  sim.every(10, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run_until(400);

  // The steady state: x = g cos(omega t - delta) / |1 - omega^2 + i rate omega|.
  const double stiff = 1 - push.omega * push.omega, drag = friction.rate * push.omega;
  const double amplitude = push.acceleration[0] / std::hypot(stiff, drag), delta = std::atan2(drag, stiff);
  const double exact = amplitude * std::cos(push.omega * sim.time() - delta);
  fmt::print("{}: energy {:.6f}, which drive and drag change: it has no error\n", outcome, energy.total());
  const double x = sim.particles().positions()[0][0];
  fmt::print("{:.1e} from the steady state of amplitude {:.6f}\n", x - exact, amplitude);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

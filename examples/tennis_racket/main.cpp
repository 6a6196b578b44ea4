// A racket thrown to turn about its middle axis turns over, again and again; half a period of its elliptic functions
// apart.
#include "engine/bodies.hpp"
#include "engine/simulation.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/rotating.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/spin.hpp"
#include "numbers/elliptic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

using namespace noether;

/// When the rate about the middle axis changed its sign, by lines between two looks.
struct Turnovers {
  std::optional<double> before;
  double at = 0;
  std::vector<double> times;

  void observe(const Snapshot<double>& now) {
    const ParticleSystem<double>& s = now.state();
    const double rate = spin_in_body<double>(s.column<BodyOrientation>()[0], s.column<BodySpin>()[0])[1];
    if (before && *before * rate < 0) times.push_back(at + (now.time() - at) * *before / (*before - rate));
    before = rate;
    at = now.time();
  }
};

int main() {
  const Vec3<double> inertia(0.00121, 0.01638, 0.01748), rate(0.0001, 10, 0);
  ParticleSystem<double> s(unit_system("si"));
  add_body(s, body_of_inertia("racket", 0.33, inertia), {.angular_velocity = rate});
  Simulation sim(std::move(s),
                 compose(Rotating<AnyHamiltonian<double>>(KineticPotential(ForceField<double>{})), schemes::verlet),
                 0.01);
  auto& energy = sim.every(1, Energy{});
  auto& momentum = sim.every(1, AngularMomentum{});
  sim.every(1, Spin{});
  auto& turnovers = sim.every(1, Turnovers{});
  sim.every(1, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run_until(60);

  // Half a period of Pi: 2 K/lambda, from the moments and the start alone.
  const Vec3<double> pi = rate.cwiseProduct(inertia);
  const double d21 = inertia[1] - inertia[0], d31 = inertia[2] - inertia[0], d32 = inertia[2] - inertia[1];
  const double p1 = pi[0] * pi[0], p2 = pi[1] * pi[1];
  // It circles about the axis of the smallest moment: Pi_1 never vanishes.
  const double w3 = p2 * d32 / inertia[1] + p1 * d31 / inertia[0];
  const double lambda = std::sqrt(w3 * d21 / (inertia[0] * inertia[1] * inertia[2]));
  const double half = 2 * complete_elliptic(d31 * p1 * d21 / inertia[0] / (d21 * w3)) / lambda;
  double shortest = 60, longest = 0;
  for (std::size_t k = 1; k < turnovers.times.size(); ++k) {
    const double between = turnovers.times[k] - turnovers.times[k - 1];
    shortest = std::min(shortest, between);
    longest = std::max(longest, between);
  }
  fmt::print("{}: it turned over {} times, every {:.4f} to {:.4f} s\n", outcome, turnovers.times.size(), shortest,
             longest);
  fmt::print("Jacobi's elliptic functions say {:.4f} s\n", half);
  fmt::print("energy within {:.0e}, angular momentum within {:.0e}\n", energy.worst(), *momentum.report().worst);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

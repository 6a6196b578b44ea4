// A Kepler orbit of e = 0.6 by RK4, ten turns of 200 steps: what is gained where every step is brought back to its
// energy, to its angular momentum, or to both?
#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/classical.hpp"
#include "integrators/projected.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

using namespace noether;

namespace {

// a = 1 and G (m0 + m1) = 1, so the period is 2 pi; at the pericenter r = 1 - e and v = sqrt((1 + e)/(1 - e)).
ParticleSystem<double> pair() {
  ParticleSystem bodies;
  bodies.add("star", 0.75, {0, 0, 0}, {0, 0, 0});
  bodies.add("planet", 0.25, {0.4, 0, 0}, {0, 2, 0});
  move_to_barycenter(bodies);
  return bodies;
}

Vec3<double> apart(const ParticleSystem<double>& s) {
  return Vec3<double>(s.positions()[1]) - Vec3<double>(s.positions()[0]);
}

Outcome follow(AnyIntegrator<double> integrator, const char* held, bool write) {
  Simulation sim(pair(), std::move(integrator), Clock<double>::fixed(0, 0.031415926535897934));
  auto& energy = sim.every(10, Energy{});
  auto& angular_momentum = sim.every(10, AngularMomentum{});
  if (write) sim.every(10, io::TrajectoryWriter{"run.h5"});
  const Vec3<double> start = apart(sim.particles());
  const Outcome outcome = sim.run(2000);
  const Vec3<double> end = apart(sim.particles());
  if (write) fmt::print("{}\n", outcome);
  fmt::print("{:<20} {:.1e} from the start, energy within {:.0e}, angular momentum within {:.0e}, {:.2f} iterations\n",
             held, std::sqrt(norm2(end - start)), energy.worst(), angular_momentum.worst(),
             sim.evaluations().projection.mean());
  if (write) fmt::print("{}\n", io::digest(sim.particles()));
  return outcome;
}

}  // namespace

int main() {
  struct Way {
    const char* name;
    std::vector<Invariant> onto;
  };
  const std::vector<Way> ways = {{"onto both", {Invariant::energy, Invariant::angular_momentum}},
                                 {"bare", {}},
                                 {"onto energy", {Invariant::energy}},
                                 {"onto ang. momentum", {Invariant::angular_momentum}}};
  for (const Way& way : ways) {
    AnyIntegrator<double> rk4 = classical(Gravity{}, method("rk4"));
    if (!way.onto.empty()) rk4 = projected(rk4, {.onto = way.onto});
    const Outcome outcome = follow(rk4, way.name, way.onto.size() == 2);
    if (!outcome.ok()) return exit_code(outcome);
  }
  return 0;
}

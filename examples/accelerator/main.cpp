// A charge of gamma = 20 through a filter of crossed fields, a solenoid and an accelerating gap: which pusher is to be
// taken?
#include "engine/simulation.hpp"
#include "forces/electromagnetic_fields.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/charged_particles.hpp"
#include "integrators/composition.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

using namespace noether;

namespace {

// q = m = c = 1. The filter lets pass what has v = 0.99875 along z; the solenoid is along z as well.
const UniformElectromagnetic crossed{.E = {0.99875, 0, 0}, .B = {0, 1, 0}};
const UniformElectromagnetic solenoid{.B = {0, 0, 20}};
const RadioFrequencyGap gap{.E0 = 3, .length = 0.5, .omega = 2, .c = 1, .phase = 4.5663706143591725};

/// On the axis, or across it.
ParticleSystem<double> electron(bool on_axis) {
  ParticleSystem<double> s;
  s.add_column<Charge>();
  const Vec3<double> along(0, 0, 0.998749217771909), across(0.1, 0, 0.9937303457);
  s.add("electron", 1, {0.02, 0, -4}, on_axis ? along : across);
  s.column<Charge>()[0] = 1;
  return s;
}

AnyIntegrator<double> by(Relativistic pusher, bool filter, const Scheme& scheme) {
  const ChargedParticlesOptions options{.relativistic = pusher, .c = 1.0};
  if (filter) return compose(ChargedParticles(crossed, options), scheme);
  return compose(ChargedParticles(Sum(InField(solenoid), InField(gap)), options), scheme);
}

struct End {
  Vec3<double> x, v;
};

End end_of(Relativistic pusher, bool filter, double step, const Scheme& scheme = schemes::verlet_aba) {
  Simulation sim(electron(filter), by(pusher, filter, scheme), step);
  static_cast<void>(sim.run_until(8));
  return {sim.particles().positions()[0], sim.particles().velocities()[0]};
}

double apart(const Vec3<double>& a, const Vec3<double>& b) { return std::sqrt(norm2(Vec3<double>(a - b))); }

}  // namespace

int main() {
  Simulation sim(electron(false), by(Relativistic::higuera_cary, false, schemes::verlet_aba), 0.1);
  auto& energy = sim.every(1, Energy{});
  sim.every(1, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run(80);
  fmt::print("{}\nkinetic energy {:.6f}\n{}\n", outcome, *energy.report().last, io::digest(sim.particles()));
  if (!outcome.ok()) return exit_code(outcome);

  const std::pair<const char*, Relativistic> pushers[] = {
      {"boris", Relativistic::boris}, {"vay", Relativistic::vay}, {"higuera_cary", Relativistic::higuera_cary}};
  const End exact = end_of(Relativistic::higuera_cary, false, 0.005, *schemes::find("kahan_li_8_s17"));
  const End kept = end_of(Relativistic::higuera_cary, true, 0.005, *schemes::find("kahan_li_8_s17"));
  for (const auto& [name, pusher] : pushers) {
    const End filtered = end_of(pusher, true, 0.5);
    const double coarse = apart(end_of(pusher, false, 0.1).x, exact.x),
                 fine = apart(end_of(pusher, false, 0.05).x, exact.x);
    fmt::print("{:<13} filter: off by {:.1e} with 16 steps; gap and solenoid: {:.1e}, {:.1e} with 80 and 160\n", name,
               apart(filtered.x, kept.x), coarse, fine);
  }
  fmt::print("after the gap it has {:.9f} of c\n", std::sqrt(norm2(exact.v)));
  return 0;
}

// A charge on a banana orbit of a tokamak: what Boris's steps keep for long times, and rk4 does not.
#include "engine/simulation.hpp"
#include "forces/electromagnetic_fields.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/charged_particles.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/charges.hpp"
#include "monitors/monitors.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

using namespace noether;

namespace {

const Tokamak tokamak{.B0 = 1, .R0 = 1, .safety = 2};
constexpr double step = 0.3141592653589793;  // a twentieth of a gyration where B = 1
const ChargeMotion motion{.fields = {AnyForce<double>(InField(tokamak))}, .c = {}};

ParticleSystem<double> ion() {
  ParticleSystem<double> s;
  s.add_column<Charge>();
  s.add("ion", 1, {1.05, 0, 0}, {0, 4.816e-4, -2.059e-3});
  s.column<Charge>()[0] = 1;
  return s;
}

AnyIntegrator<double> boris(const Scheme& scheme) {
  return compose(ChargedParticles(tokamak, {.rotation = Rotation::boris}), scheme);
}

Outcome follow(const char* name, AnyIntegrator<double> by) {
  Simulation sim(ion(), std::move(by), step);
  CanonicalMomentum around;
  around.watch(motion);
  auto& energy = sim.every(50, Energy{});
  auto& p = sim.every(50, around);
  const Outcome outcome = sim.run(250'000);
  fmt::print("{:<16} energy within {:.1e}, canonical momentum within {:.1e}\n", name, energy.worst(), p.worst());
  return outcome;
}

}  // namespace

int main() {
  Simulation sim(ion(), boris(schemes::verlet_aba), step);
  MagneticMoment at_center, at_ion;
  at_center.watch(motion);
  at_ion.watch(motion);
  at_ion.at = MomentPlace::particle;
  auto& energy = sim.every(50, Energy{});
  auto& center = sim.every(50, at_center);
  auto& ion_itself = sim.every(50, at_ion);
  sim.every(500, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run(250'000);
  fmt::print("{}\nenergy within {:.0e}\n{}\n", outcome, energy.worst(), io::digest(sim.particles()));
  if (!outcome.ok()) return exit_code(outcome);
  fmt::print("mu swings by {:.1e} at the ion, by {:.1e} at its gyrocentre; a bounce takes {:.0f} gyrations\n",
             ion_itself.swing(), center.swing(), center.bounce_period() / (20 * step));
  const std::pair<const char*, AnyIntegrator<double>> others[] = {
      {"boris", boris(schemes::verlet_aba)},
      {"boris, order 4", boris(schemes::yoshida_4)},
      {"helix", compose(ChargedParticles(tokamak), schemes::verlet_aba)},
      {"rk4", classical(Sum(InField(tokamak)), method("rk4"))}};
  for (const auto& [name, by] : others) {
    const Outcome followed = follow(name, by);
    if (!followed.ok()) return exit_code(followed);
  }
  return 0;
}

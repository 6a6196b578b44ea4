// A proton of 1 MeV in the Earth's dipole: it gyrates, bounces between its mirror points and drifts around the Earth.
#include "engine/simulation.hpp"
#include "forces/electromagnetic_fields.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/charged_particles.hpp"
#include "integrators/composition.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/charges.hpp"
#include "monitors/monitors.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

using namespace noether;

namespace {

constexpr double earth = 6378100, light = 299792458;
const MagneticDipole dipole{.moment = {0, 0, -8.05e15}};

// On the equator at four radii, with a pitch angle of 30 degrees: v^2 = c^2 (1 - 1/gamma^2), gamma = 1 + E/m c^2.
ParticleSystem<double> proton() {
  ParticleSystem<double> s(unit_system("si"));
  s.add_column<Charge>();
  s.add("proton", 1.67262192369e-27, {4 * earth, 0, 0}, {0, 6.91446e6, 1.197618e7});
  s.column<Charge>()[0] = 1.602176634e-19;
  return s;
}

}  // namespace

int main() {
  Simulation sim(proton(),
                 compose(ChargedParticles(dipole, {.relativistic = Relativistic::higuera_cary}), schemes::verlet_aba),
                 2e-3);
  MagneticMoment moment;
  moment.watch({.fields = {AnyForce<double>(InField(dipole))}, .c = light});
  auto& energy = sim.every(10, Energy{});
  auto& mu = sim.every(5, moment);
  sim.every(5, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run(30'000);
  fmt::print("{}\nenergy within {:.0e}\n{}\n", outcome, energy.worst(), io::digest(sim.particles()));
  if (!outcome.ok()) return exit_code(outcome);
  const double turned = std::atan2(mu.center()[1], mu.center()[0]);
  fmt::print("mu swings by {:.1e}; {} turning points, a bounce takes {:.3f} s; around the Earth in {:.0f} s\n",
             mu.swing(), mu.turns(), mu.bounce_period(), 2 * std::numbers::pi / std::abs(turned) * 60);
  return 0;
}

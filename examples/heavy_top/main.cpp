// Lagrange's top: how it nods, against its closed form, by every kind of method.
#include "engine/bodies.hpp"
#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/on_sites.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/lie/body_motion.hpp"
#include "integrators/rotating.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "monitors/spin.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>
#include <utility>

using namespace noether;

ParticleSystem<double> leaning_top() {
  ParticleSystem<double> s(unit_system("reduced"));
  const double lean = 0.5;
  add_body(s, top("top", 2, {1, 1, 0.5}, {0, 0, 0.5}),
           {.orientation = {std::cos(lean / 2), 0, std::sin(lean / 2), 0}, .angular_velocity = Vec3<double>(0, 0, 6)});
  return s;
}

/// Weight, on the site at its centre of mass.
ForceField<double> weight() {
  ForceField<double> on_top, on_site;
  on_site.add(UniformField{{0, 0, -1}});
  on_top.add(OnSites<double>(on_site));
  return on_top;
}

/// How far the axis is from where it began after one nod, and has gone round, by so many steps of an integrator.
void tell_nod(const std::string& method, std::string_view turns, AnyIntegrator<double> integrator, int steps) {
  const double period = 2.62410021994501064743, precession = 0.97016986498882435069;
  Simulation<double> sim(leaning_top(), std::move(integrator), period / steps);
  if (!sim.run(steps).ok()) return;
  const Mat3<double> r = rotation_matrix<double>(sim.particles().column<BodyOrientation>()[0]);
  const double nod = std::abs(std::acos(r(2, 2)) - 0.5), round = std::abs(std::atan2(r(1, 2), r(0, 2)) - precession);
  fmt::print("  {:<21} {:<11} {:4} steps, {:4} evaluations: nutation off by {:.1e}, precession by {:.1e}\n", method,
             turns, steps, sim.evaluations().force, nod, round);
}
/// By a splitting into turns and kicks.
void tell_splitting(const std::string& name, Rotor rotor, int steps) {
  const AnyHamiltonian<double> top{KineticPotential{weight()}};
  const Rotating<AnyHamiltonian<double>> turning(top, {.rotor = rotor});
  tell_nod(name, rotor_name(rotor), AnyIntegrator<double>(compose(turning, *schemes::find(name))), steps);
}
/// By a method on the group of rotations, with steps of one length.
void tell_group(const std::string& name, int steps) {
  MethodOptions options;
  if (methods::find(name)->adaptive) options.adaptive = false;
  tell_nod(name, "exponential", AnyIntegrator<double>(lie(weight(), method(name, options))), steps);
}

int main() {
  Simulation sim(leaning_top(),
                 compose(Rotating<AnyHamiltonian<double>>(KineticPotential(weight())), *schemes::find("srkn14a")),
                 0.05);
  auto& energy = sim.every(1, Energy{});
  auto& shadow = sim.every(1, ShadowHamiltonian{});
  sim.every(1, Spin{});
  sim.every(1, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run_until(50);
  fmt::print("{}: energy within {:.1e}; shadow {}\n", outcome, energy.worst(), shadow.verdict());

  fmt::print("one nod and its way round, against elliptic integrals:\n");
  for (const char* scheme : {"verlet", "yoshida_4"}) {
    tell_splitting(scheme, Rotor::axes, 100);
    tell_splitting(scheme, Rotor::exact, 100);
  }
  tell_splitting("lie_group_variational", Rotor::variational, 100);
  tell_splitting("blanes_moan_s6", Rotor::exact, 50);
  tell_splitting("srkn6b", Rotor::exact, 50);
  tell_splitting("srkn11b", Rotor::exact, 30);
  tell_splitting("srkn14a", Rotor::exact, 30);
  tell_group("rkmk_euler", 300);
  tell_group("rkmk_heun", 150);
  for (const char* name :
       {"crouch_grossman_3", "crouch_grossman_4", "commutator_free_3", "commutator_free_4", "rkmk_rk4"})
    tell_group(name, 75);
  tell_group("rkmk_dormand_prince_5", 50);
  tell_group("rkmk_cash_karp_5", 50);
  tell_group("rkmk_dop853", 25);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

// Lagrange's top: how it nods, against its closed form, by every kind of method.
#include "engine/bodies.hpp"
#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/on_sites.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/rotating.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "monitors/spin.hpp"

#include <fmt/format.h>

#include <cmath>

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

/// How far the axis is from where it began after one nod, and has gone round, by so many steps of a method.
void tell_nod(const std::string& method, Rotor rotor, int steps) {
  const double period = 2.62410021994501064743, precession = 0.97016986498882435069;
  Simulation sim(
      leaning_top(),
      compose(Rotating<AnyHamiltonian<double>>(KineticPotential(weight()), {.rotor = rotor}), *schemes::find(method)),
      period / steps);
  if (!sim.run(steps).ok()) return;
  const Mat3<double> r = rotation_matrix<double>(sim.particles().column<BodyOrientation>()[0]);
  const double nod = std::abs(std::acos(r(2, 2)) - 0.5), round = std::abs(std::atan2(r(1, 2), r(0, 2)) - precession);
  fmt::print("  {:<16} {:<6} {:4} steps, {:5} kicks: nutation off by {:.1e}, precession by {:.1e}\n", method,
             rotor == Rotor::exact ? "exact" : "axes", steps, sim.evaluations().force, nod, round);
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
  for (const char* method : {"verlet", "yoshida_4"}) {
    tell_nod(method, Rotor::axes, 100);
    tell_nod(method, Rotor::exact, 100);
  }
  tell_nod("blanes_moan_s6", Rotor::exact, 50);
  tell_nod("srkn6b", Rotor::exact, 50);
  tell_nod("srkn11b", Rotor::exact, 30);
  tell_nod("srkn14a", Rotor::exact, 30);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

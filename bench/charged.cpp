/// What a step of Boris's costs a charge: uniform fields, a tokamak, a dipole, from a thousand charges to four million,
/// on one thread and on two; many steps at a time, and one step at a time, when all charges go through memory each
/// time.
///
/// Protocol: seven slices for each row, of so many steps that they take some tenths of a second; medians of processor
/// times by particles and steps on one thread, and of pairs of wall times for what two threads gain.

#include "bench/support.hpp"

#include "engine/simulation.hpp"
#include "forces/electromagnetic_fields.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/charged_particles.hpp"
#include "integrators/composition.hpp"
#include "numbers/parallel.hpp"

#include <cmath>

using namespace noether;

namespace {

ParticleSystem<double> charges(Index n) {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add_column<Charge>();
  for (Index i = 0; i < n; ++i) {
    const double k = static_cast<double>(i);
    s.add("", 1, {1.05 + 0.1 * std::sin(0.7 * k), 0.1 * std::cos(1.3 * k), 0.1 * std::sin(1.9 * k)},
          {1e-3 * std::cos(k), 5e-4, -2e-3 * std::sin(k)});
    s.column<Charge>()[i] = 1;
  }
  return s;
}

template <class Field> void add_rows(const bench::Rows& rows, const std::string& name, const Field& field) {
  for (const Index n : {Index{1000}, Index{30'000}, Index{1'000'000}, Index{4'000'000}}) {
    set_thread_count(1);
    ForceField<double> forces;
    forces.add(InField(field));
    const ChargedParticles<ForceField<double>> hamiltonian(forces, {.rotation = Rotation::boris});
    Simulation sim(charges(n), compose(hamiltonian, schemes::verlet_aba), 0.3);
    const std::string row = fmt::format("{}_{}", name, n);
    const auto measure = [&](const std::string& figure, std::int64_t steps, const auto& work) {
      std::vector<double> times;
      for (int slice = 0; slice < 7; ++slice)
        times.push_back(1e9 * bench::processor_seconds_of([&] { work(steps); }) / static_cast<double>(n * steps));
      rows.add(row, figure, bench::Measured(times), "ns", n);
    };
    const auto run = [&](std::int64_t steps) { static_cast<void>(sim.run(steps)); };
    const std::int64_t many = std::max<std::int64_t>(320, 40'000'000 / n);
    run(2);
    measure("particle_step_ns", many, run);
    if (n <= 1'000'000) {
      const bench::Measured gain = bench::times_as_quick(2, [&] { return bench::seconds_of([&] { run(many); }); });
      rows.add(row, "times_as_quick_on_2", gain, "1", n);
    }
    set_thread_count(1);
    ParticleSystem<double> one_by_one = sim.particles();
    one_by_one.clock() = Clock<double>::fixed(0, 0.3);
    auto integrator = compose(hamiltonian, schemes::verlet_aba);
    integrator.bind(one_by_one);
    measure("particle_step_ns_one_by_one", std::max<std::int64_t>(8, 8'000'000 / n), [&](std::int64_t steps) {
      for (std::int64_t k = 0; k < steps; ++k) integrator.advance(one_by_one, {.steps = 1});
    });
  }
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("charged", count, arguments);
  add_rows(rows, "uniform", UniformElectromagnetic{.E = {0.01, 0, 0}, .B = {0, 0, 1}});
  add_rows(rows, "tokamak", Tokamak{});
  add_rows(rows, "dipole", MagneticDipole{.moment = {0, 0, 3}});
}

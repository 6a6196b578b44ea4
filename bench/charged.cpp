/// What a step of Boris's costs a charge: uniform fields, a tokamak, a dipole, from a thousand charges to four million,
/// on one thread and on two; many steps at a time, and one step at a time, when all charges go through memory each
/// time.
///
/// Protocol: seven slices for each row, of so many steps that they take some tenths of a second; medians of processor
/// times by particles and steps on one thread, and of pairs of wall times for what two threads gain.

#include "bench/support.hpp"

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
    const std::string row = fmt::format("{}_{}", name, n);
    ForceField<double> forces;
    forces.add(InField(field));
    auto integrator =
        compose(ChargedParticles<ForceField<double>>(forces, {.rotation = Rotation::boris}), schemes::verlet_aba);
    ParticleSystem<double> s = charges(n);
    s.clock() = Clock<double>::fixed(0, 0.3);
    integrator.bind(s);
    const auto many = [&](std::int64_t steps) { integrator.advance(s, {.steps = steps}); };
    const auto one_by_one = [&](std::int64_t steps) {
      for (std::int64_t k = 0; k < steps; ++k) integrator.advance(s, {.steps = 1});
    };
    const auto measure = [&](const std::string& figure, std::int64_t steps, const auto& work) {
      set_thread_count(1);
      std::vector<double> times;
      for (int slice = 0; slice < 7; ++slice)
        times.push_back(1e9 * bench::processor_seconds_of([&] { work(steps); }) / static_cast<double>(n * steps));
      rows.add(row, figure, bench::Measured(times), "ns", n);
    };
    const std::int64_t steps = std::max<std::int64_t>(64, 40'000'000 / n);
    many(2);
    measure("particle_step_ns", steps, many);
    measure("particle_step_ns_one_by_one", std::max<std::int64_t>(8, 8'000'000 / n), one_by_one);
    const bench::Measured gain = bench::times_as_quick(2, [&] { return bench::seconds_of([&] { many(steps); }); });
    rows.add(row, "times_as_quick_on_2", gain, "1", n);
  }
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("charged", count, arguments);
  add_rows(rows, "uniform", UniformElectromagnetic{.E = {0.01, 0, 0}, .B = {0, 0, 1}});
  add_rows(rows, "tokamak", Tokamak{});
  add_rows(rows, "dipole", MagneticDipole{.moment = {0, 0, 3}});
}

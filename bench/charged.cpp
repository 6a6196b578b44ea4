/// What a step of Boris's costs a charge: uniform fields, a tokamak, a dipole, from a thousand charges to a million, on
/// one thread and on all.
///
/// Protocol: seven slices for each row, of so many steps that they take some tenths of a second; medians of wall times
/// by particles and steps.

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
  for (const Index n : {Index{1000}, Index{30'000}, Index{1'000'000}}) {
    for (const int threads : {1, 2}) {
      set_thread_count(threads);
      ForceField<double> forces;
      forces.add(InField(field));
      Simulation sim(
          charges(n),
          compose(ChargedParticles<ForceField<double>>(forces, {.rotation = Rotation::boris}), schemes::verlet_aba),
          0.3);
      const auto steps = std::max<std::int64_t>(2, 3'000'000 / n);
      static_cast<void>(sim.run(2));
      std::vector<double> times;
      for (int slice = 0; slice < 7; ++slice) {
        const double seconds = bench::seconds_of([&] { static_cast<void>(sim.run(steps)); });
        times.push_back(1e9 * seconds / static_cast<double>(n * steps));
      }
      rows.add(fmt::format("{}_{}", name, n), fmt::format("particle_step_ns_on_{}", threads), bench::Measured(times),
               "ns", n);
    }
  }
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("charged", count, arguments);
  add_rows(rows, "uniform", UniformElectromagnetic{.E = {0.01, 0, 0}, .B = {0, 0, 1}});
  add_rows(rows, "tokamak", Tokamak{});
  add_rows(rows, "dipole", MagneticDipole{.moment = {0, 0, 3}});
}

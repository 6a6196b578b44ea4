/// What 512 rigid molecules of water make of their energy: no drift, as far as a night tells.

#include "constraints/structure_constraints.hpp"
#include "engine/simulation.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/pair_potentials.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/langevin.hpp"
#include "monitors/monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "monitors/temperature.hpp"
#include "scene/constrained.hpp"
#include "scene/water_box.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

namespace noether::water_drift {
namespace {

using namespace units::molecular;

/// SPC/E with a reaction field, both of whose forces end with four derivatives.
ForceField<double> smooth_forces() {
  ForceField<double> forces;
  forces.add(LennardJonesForce{.cutoff = 0.9 * nm, .cutoff_style = Cutoff::switch_c4, .switch_from = 0.7 * nm});
  forces.add(ReactionFieldForce{{.radius = 0.9 * nm, .switched_from = 0.7 * nm}});
  return forces;
}

/// At 300 K after some picoseconds in a bath, at time 0 and without momentum.
ParticleSystem<double> warm_water(const ForceField<double>& forces, std::optional<double> hydrogen_mass, double step) {
  ParticleSystem<double> water = WaterBox{.model = WaterModel::spce,
                                          .molecules = 512,
                                          .density = 0.997 * g_per_cm3,
                                          .hydrogen_mass = hydrogen_mass,
                                          .temperature = 300 * K,
                                          .seed = 7}
                                     .build();
  const ConstraintSet rigid = rigid_molecules(water);
  REQUIRE(minimize(water, AnyForce<double>(forces), rigid, {.max_force = 100 * kJ_per_mol / nm}).converged());
  const Langevin bath(KineticPotential(forces, rigid), {.temperature = 300 * K, .friction = 5 / ps, .seed = 3});
  Simulation<double> warming(std::move(water), compose(bath, word("BAOAB")), step);
  REQUIRE(warming.run_until(8 * ps).ok());
  ParticleSystem<double> warm = warming.particles();
  Vec3<double> momentum = Vec3<double>::Zero();
  double mass = 0;
  for (Index i = 0; i < warm.size(); ++i) {
    momentum += warm.masses()[i] * warm.velocities()[i];
    mass += warm.masses()[i];
  }
  for (Index i = 0; i < warm.size(); ++i) warm.velocities().add(i, -momentum / mass);
  warm.phase() = {};
  return warm;
}

struct Drift {
  double value = 0, error = 0;  ///< [kT/ns/atom]
};

/// Drifts of the energy itself, and of what the method keeps in its place, over a run of Verlet's method.
std::pair<Drift, Drift> drifts(std::optional<double> hydrogen_mass, double step, double until) {
  const ForceField<double> forces = smooth_forces();
  const ParticleSystem<double> warm = warm_water(forces, hydrogen_mass, step);
  const ConstraintSet rigid = rigid_molecules(warm);
  Simulation<double> sim(warm, compose(KineticPotential(forces, rigid), schemes::verlet), step);
  const Energy& energy = sim.every(2, Energy{});
  const ShadowHamiltonian<double>& shadow = sim.every(20, ShadowHamiltonian<double>({4, 8}));
  const Temperature& temperature = sim.every(10, Temperature{});
  REQUIRE(sim.run_until(until).ok());
  const MonitorReport plain = energy.report(), flat = shadow.report(), heat = temperature.report();
  const double unit = *shadow.scale() / (k_B * *heat.rms * static_cast<double>(warm.size())) * ns;  // of a slope
  const std::pair<Drift, Drift> found{{*plain.drift, *plain.drift_error},
                                      {*flat.slope * unit, *flat.slope_error * unit}};
  fmt::print(
      "512 SPC/E, {} fs, {} ps at {:.0f} K: the energy drifts by {:.2e} +- {:.1e} kT/ns/atom, the shadow "
      "Hamiltonian by {:.2e} +- {:.1e}; it fluctuates by {:.1e}, the energy by {:.1e}\n",
      step / fs, until, *heat.rms, found.first.value, found.first.error, found.second.value, found.second.error,
      shadow.fluctuation(shadow.best()), *plain.rms);
  return found;
}

TEST_CASE("512 rigid waters drift by less than a thousandth of kT per nanosecond and atom at 2 fs",
          "[constraints][nightly]") {
  const auto [energy, shadow] = drifts({}, 2 * fs, 30 * ps);
  CHECK(energy.error < 1e-3);
  CHECK(std::abs(energy.value) < 1e-3 + 3 * energy.error);
  CHECK(shadow.error < 1e-4);
  CHECK(std::abs(shadow.value) < 1e-3);
}

TEST_CASE("512 rigid waters with hydrogens of 3 u drift by less than that at 4 fs", "[constraints][nightly]") {
  const auto [energy, shadow] = drifts(3 * u, 4 * fs, 160 * ps);
  CHECK(energy.error < 3e-4);
  CHECK(std::abs(energy.value) < 1e-3);
  CHECK(shadow.error < 1e-4);
  CHECK(std::abs(shadow.value) < 1e-3);
}

}  // namespace
}  // namespace noether::water_drift

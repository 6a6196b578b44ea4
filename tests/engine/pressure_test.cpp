// The pressure: against the ideal gas, LAMMPS's figures, and what a change of volume does to the energy.

#include "monitors/pressure.hpp"

#include "engine/simulation.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/langevin.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/liquid.hpp"
#include "tests/support/refusal.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace noether {
namespace {

/// Tells no virial.
struct Secretive {
  static ForceClaims claims() { return {.virial = false, .periodic = true}; }
  template <class Real> void add_to(ForceSink<Real>& /*out*/, const ParticleSystem<Real>& /*s*/) const {}
};

LennardJonesForce pair_force(Cutoff style) {
  return {.cutoff = 2.5, .cutoff_style = style, .epsilon = 1.0, .sigma = 1.0};
}

template <class F> Simulation<double> fluid_run(const ParticleSystem<double>& s, const F& force) {
  return Simulation<double>(s, compose(test::kinetic_potential(force), schemes::verlet), 0.005);
}

template <class Make> std::string refusal_of_pressure(const Make& make) {
  return test::refusal_of([&] {
    auto sim = make();
    sim.every(1, Pressure{});
  });
}

}  // namespace

TEMPLATE_TEST_CASE("an ideal gas has the pressure of its momenta alone", "[pressure]", double, Quad) {
  using Real = TestType;
  ParticleSystem<double> gas;
  gas.set_box(Box::periodic({2, 4, 8}));
  gas.add("a", 2, {0.5, 0.5, 0.5}, {1, 0, -2});
  gas.add("b", 1, {1.5, 3.5, 7.5}, {3, 4, 0});
  gas.add("dust", 0, {1, 1, 1}, {9, 9, 9});
  Simulation<Real> sim(gas.as<Real>(), compose(test::kinetic_potential<Real>(), schemes::verlet), 0.25);
  auto& pressure = sim.every(1, Pressure{});
  REQUIRE(sim.run(30).ok());
  // m v v^T summed: xx = 2 + 9, xy = 12, xz = -4, yy = 16, zz = 8; over a volume of 64.
  CHECK(pressure.tensor() ==
        std::array<double, 9>{11 / 64.0, 12 / 64.0, -4 / 64.0, 12 / 64.0, 16 / 64.0, 0, -4 / 64.0, 0, 8 / 64.0});
  CHECK(pressure.value() == pressure.series()[0].values[0]);
  CHECK(std::abs(pressure.value() - 35.0 / 192) < 1e-16);
  CHECK(pressure.series()[1].shape == std::vector<Index>{3, 3});
  const MonitorReport report = pressure.report();
  CHECK(report.samples == 31);
  CHECK(*report.first == *report.last);
  CHECK(std::abs(*report.slope) < 1e-15);
  CHECK(report.note.find("mean 0.182292 +- ") == 0);
}

TEST_CASE("the pressure of LAMMPS's in.lj at step 0 is LAMMPS's", "[pressure][oracle]") {
  // Printed by LAMMPS for bench/in.lj at step 0: P -5.0197073 at T 1.44, N = 32000.
  auto sim = fluid_run(test::liquid(20, 0.8442, 1.44), pair_force(Cutoff::plain));
  auto& pressure = sim.every(1, Pressure{});
  REQUIRE(sim.run(0).ok());
  CHECK(fmt::format("{:.7f}", pressure.value()) == "-5.0197073");
}

TEST_CASE("the pressure of the forces is minus the energy's derivative by volume", "[pressure]") {
  const ParticleSystem<double> liquid = test::liquid(3, 0.8442, 1.44, 0.1);
  const LennardJonesForce force = pair_force(Cutoff::switch_c4);
  // The energy in a box whose edges are longer by 1 + e_k along k, with everything in it.
  const auto energy = [&](const Vec3<double>& stretch) {
    ParticleSystem<double> s;
    const Vec3<double> factor = Vec3<double>::Ones() + stretch;
    s.set_box(Box::periodic(liquid.box().edges().cwiseProduct(factor)));
    for (Index i = 0; i < liquid.size(); ++i) {
      s.add("", 1, Vec3<double>(liquid.positions()[i]).cwiseProduct(factor), {0, 0, 0});
    }
    VectorColumn<double> a(s.size());
    ForceSink<double> sink(a, s, {.energy = true});
    force.add_to(sink, s);
    return sink.potential();
  };
  auto sim = fluid_run(liquid, force);
  auto& pressure = sim.every(1, Pressure{});
  REQUIRE(sim.run(0).ok());
  for (int k = 0; k < 3; ++k) {
    CAPTURE(k);
    Vec3<double> e = Vec3<double>::Zero();
    e[k] = 1e-5;
    double momenta = 0;
    for (Index i = 0; i < liquid.size(); ++i) momenta += liquid.velocities()[i][k] * liquid.velocities()[i][k];
    const double of_forces = -(energy(e) - energy(-e)) / 2e-5;
    const double found = pressure.tensor()[static_cast<std::size_t>(4 * k)] * liquid.box().volume();
    CHECK(std::abs(found - momenta - of_forces) < 1e-6 * std::abs(momenta));
  }
}

TEST_CASE("a pressure of molecules is told in bar too, and under a bath", "[pressure]") {
  ParticleSystem<double> gas(unit_system("molecular"));
  gas.set_box(Box::periodic({1, 1, 1}));
  gas.add("Ar", 3, {0.5, 0.5, 0.5}, {1, 1, 1});
  const auto bath = test::in_bath({}, {.temperature = 300, .friction = 1e-9});
  Simulation<double> sim(gas, compose(bath, word("BAOAB")), 0.001);
  auto& pressure = sim.every(1, Pressure{});
  REQUIRE(sim.run(0).ok());
  // 1 kJ/mol/nm^3 = 1000 J / 6.02214076e23 / 1e-27 m^3 = 16.6053906717... bar.
  CHECK(pressure.report().note == "mean 3 kJ/mol/nm^3, which is 49.8162 bar");
}

TEST_CASE("pressures do not depend on who else looks", "[pressure][determinism]") {
  const auto final_pressure = [](int energy_cadence) {
    auto sim = fluid_run(test::liquid(3, 0.8442, 1.44), pair_force(Cutoff::shifted_force));
    auto& pressure = sim.every(10, Pressure{});
    if (energy_cadence > 0) sim.every(energy_cadence, Energy{});
    REQUIRE(sim.run(20).ok());
    return pressure.tensor();
  };
  CHECK(final_pressure(0) == final_pressure(1));
  CHECK(final_pressure(0) == final_pressure(7));
}

TEST_CASE("a pressure that cannot be known is refused before the first step", "[pressure][messages]") {
  ParticleSystem<double> pair;
  pair.add("a", 1, {0, 0, 0}, {0, 0, 0});
  pair.add("b", 1, {0, 1, 0}, {0, 0, 0});
  CHECK(refusal_of_pressure([&] { return fluid_run(pair, Sum<>{}); }) ==
        "monitor 'pressure' needs a periodic box, because it divides by the volume; give the particles a box");
  pair.set_box(Box::periodic({4, 4, 4}));
  CHECK(refusal_of_pressure([&] { return fluid_run(pair, Sum<>{}); }).empty());
  CHECK(refusal_of_pressure([&] { return fluid_run(pair, Sum(Sum<>{}, Secretive{})); }) ==
        "monitor 'pressure' needs the virial, but 'kinetic_potential' or one of its forces does not compute it");
}

}  // namespace noether

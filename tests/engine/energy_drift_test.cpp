// The drift of the energy as molecular dynamics tells it, against energies taken by hand.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/lennard_jones.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/liquid.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace noether {
namespace {

/// Keeps the energies it sees.
struct EnergyDiary {
  static Request wanted() { return {.energy = true}; }
  void observe(const Snapshot<double>& now) {
    total.add(now.time(), now.energy().total());
    kinetic.add(now.time(), now.energy().kinetic);
  }
  SeriesStatistics total, kinetic;
};

/// What the report should say; `unit` is what one of the field's units is in energy by time and atom.
std::string drift_in_words(const SeriesStatistics& total, double unit, const char* name) {
  const auto line = total.line();
  return fmt::format("drift {:.3g} +- {:.1g} {}", line->slope / unit, line->error / unit, name);
}

/// Both are sums over the same looks, in another order.
bool is_near(double found, double expected) { return std::abs(found - expected) < 1e-6 * std::abs(expected); }

ParticleSystem<double> springs_in_molecular_units() {
  ParticleSystem<double> s(unit_system("molecular"));
  s.add("a", 40, {0.1, 0, 0}, {0, 0.2, 0});
  s.add("b", 20, {0, 0.2, 0}, {0, 0, 0.3});
  s.add("dust", 0, {0, 0, 0}, {0, 0, 0});
  return s;
}

}  // namespace

TEST_CASE("in molecular units the drift is told in kT/ns/atom", "[energy]") {
  Simulation<double> sim(springs_in_molecular_units(),
                         compose(test::kinetic_potential(HarmonicField{.k = 4000}), schemes::verlet), 0.03);
  auto& energy = sim.every(1, Energy{});
  auto& diary = sim.every(1, EnergyDiary{});
  REQUIRE(sim.run(333).ok());
  // A field keeps no momentum: two atoms with mass have six degrees of freedom.
  const double kT = 2 * diary.kinetic.mean() / 6;
  const MonitorReport report = energy.report();
  CHECK(report.note == drift_in_words(diary.total, 2 * kT / 1000, "kT/ns/atom"));
  // The same as a number: energy by time is kJ/mol/ps, of two atoms.
  const SeriesStatistics::Line line = diary.total.line().value();
  CHECK(report.drift_unit == "kT/ns/atom");
  CHECK(is_near(report.drift.value(), line.slope / (2 * kT / 1000)));
  CHECK(is_near(report.drift_error.value(), line.error / (2 * kT / 1000)));
  // It goes on with the run.
  Simulation<double> again(springs_in_molecular_units(),
                           compose(test::kinetic_potential(HarmonicField{.k = 4000}), schemes::verlet), 0.03);
  auto& restored = again.every(1, Energy{});
  again.every(1, EnergyDiary{});
  again.restore(sim.save());
  CHECK(restored.report().note == report.note);
  CHECK(restored.report().drift == report.drift);
  CHECK(restored.report().drift_error == report.drift_error);
}

TEST_CASE("in a box in reduced units the drift is told in epsilon/tau/atom", "[energy]") {
  Simulation<double> sim(
      test::liquid(2, 0.8442, 1.44),
      compose(test::kinetic_potential(LennardJonesForce{.cutoff = 1.4, .epsilon = 1.0, .sigma = 1.0}), schemes::verlet),
      0.01);
  auto& energy = sim.every(1, Energy{});
  auto& diary = sim.every(1, EnergyDiary{});
  REQUIRE(sim.run(100).ok());
  CHECK(energy.report().note == drift_in_words(diary.total, 32, "epsilon/tau/atom"));
  CHECK(energy.report().drift_unit == "epsilon/tau/atom");
  CHECK(is_near(energy.report().drift.value(), diary.total.line()->slope / 32));
}

TEST_CASE("orbits, baths and a single look have no drift by atom", "[energy]") {
  ParticleSystem<double> pair;
  pair.add("sun", 1, {0, 0, 0}, {0, 0, 0});
  pair.add("planet", 0.001, {1, 0, 0}, {0, 1, 0});
  Simulation<double> orbit(pair, compose(test::kinetic_potential(Gravity{}), schemes::verlet), 0.01);
  auto& of_orbit = orbit.every(1, Energy{});
  REQUIRE(orbit.run(50).ok());
  CHECK(of_orbit.report().note.empty());
  CHECK_FALSE(of_orbit.report().drift);
  Simulation<double> one_look(springs_in_molecular_units(),
                              compose(test::kinetic_potential(HarmonicField{.k = 4000}), schemes::verlet), 0.03);
  auto& seen_once = one_look.every(1, Energy{});
  REQUIRE(one_look.run(0).ok());
  CHECK(seen_once.report().note.empty());
  CHECK_FALSE(seen_once.report().drift);
}

TEST_CASE("means of a series have the error of their blocks", "[statistics]") {
  SeriesStatistics series;
  CHECK(series.mean() == 0);
  for (int n = 0; n < 19; ++n) series.add(n, n % 2);
  CHECK(series.mean() == 9.0 / 19);
  CHECK_FALSE(series.mean_error());
  series.add(19, 1);
  // Twenty values, ten of each: variance 20/19 of a quarter, by 20.
  CHECK(series.mean() == 0.5);
  CHECK(std::abs(*series.mean_error() - std::sqrt(0.25 * 20 / 19 / 20)) < 1e-15);
  for (int n = 20; n < 1001; ++n) series.add(n, n % 2);
  CHECK(std::abs(series.mean() - 500.0 / 1001) < 1e-15);
}

}  // namespace noether

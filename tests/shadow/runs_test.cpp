/// The shadow Hamiltonian in runs: it changes nothing, starts again where it was, looks in bursts, refuses what has
/// none.

#include "tests/shadow/support.hpp"

#include "forces/external_fields.hpp"
#include "forces/linear_drag.hpp"
#include "integrators/damped.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

using namespace noether;
using Catch::Matchers::Contains;

namespace {

Simulation<double> planets(const Scheme& scheme) {
  return Simulation(test::outer_planets(), compose(test::wisdom_holman({}), scheme), 100.0);
}
Simulation<double> field(CompositionOptions options = {}) {
  return Simulation(test::henon_heiles_start(),
                    compose(test::kinetic_potential(test::HenonHeilesField{}), schemes::yoshida_4, options), 0.1);
}

/// Keeps what was looked at.
struct Steps {
  std::vector<std::int64_t>* seen;
  static std::int64_t steps_in_a_row() { return 3; }
  void observe(const Snapshot<double>& now) { seen->push_back(now.step()); }
};

}  // namespace

TEST_CASE("a run under the eyes of the shadow ends in the same bits", "[shadow]") {
  for (const std::int64_t cadence : {1, 40}) {
    Simulation<double> bare = planets(schemes::aba_10_6_4), watched = planets(schemes::aba_10_6_4);
    watched.every(cadence, ShadowHamiltonian<>());
    REQUIRE(bare.run(217).ok());
    REQUIRE(watched.run(217).ok());
    CHECK(test::same_bits(bare.particles(), watched.particles()));
    CHECK(bare.evaluations().force == watched.evaluations().force);
  }
}

TEST_CASE("a shadow that starts again in the middle of its window goes on with the same bits", "[shadow]") {
  for (const bool compensated : {false, true}) {
    Simulation<double> whole = field({.compensated = compensated}), first = field({.compensated = compensated}),
                       second = field({.compensated = compensated});
    auto& expected = whole.every(30, ShadowHamiltonian<>());
    first.every(30, ShadowHamiltonian<>());
    auto& found = second.every(30, ShadowHamiltonian<>());
    REQUIRE(whole.run(200).ok());
    REQUIRE(first.run(67).ok());
    second.restore(first.save());
    REQUIRE(second.run(133).ok());
    const MonitorReport a = expected.report(), b = found.report();
    CHECK(a.samples == b.samples);
    CHECK(a.samples == 7);  // one for each burst
    CHECK(a.fluctuation == b.fluctuation);
    CHECK(a.last == b.last);
    CHECK(a.slope == b.slope);
    CHECK(a.verdict == b.verdict);
  }
}

TEST_CASE("saved windows whose parts do not fit are refused", "[shadow]") {
  Simulation<double> simulation = field();
  simulation.every(1, ShadowHamiltonian<>());
  REQUIRE(simulation.run(20).ok());
  const SavedRun good = simulation.save();
  simulation.restore(good);
  const auto damaged = [&](const std::string& key, const auto& damage) {
    SavedRun bad = good;
    damage(bad.parts.at("shadow_hamiltonian").at("state/" + key));
    CHECK_THROWS_WITH(simulation.restore(bad), Contains("the saved window of a shadow Hamiltonian is inconsistent"));
  };
  damaged("columns", [](SavedArray& array) { std::get<std::vector<double>>(array).pop_back(); });
  damaged("numbers", [](SavedArray& array) { std::get<std::vector<double>>(array).pop_back(); });
  damaged("shape", [](SavedArray& array) { std::get<std::vector<std::int64_t>>(array)[1] = -1; });
  damaged("shape", [](SavedArray& array) { std::get<std::vector<std::int64_t>>(array)[1] = 2; });
  damaged("shape", [](SavedArray& array) { std::get<std::vector<std::int64_t>>(array)[2] = 7; });
  damaged("shape", [](SavedArray& array) { std::get<std::vector<std::int64_t>>(array).resize(99, 1); });
}

TEST_CASE("a monitor may look at several steps in a row", "[shadow]") {
  for (const std::int64_t cadence : {1, 2, 3, 10}) {
    std::vector<std::int64_t> seen, expected;
    Simulation<double> simulation = field();
    simulation.every(cadence, Steps{&seen});
    REQUIRE(simulation.run(25).ok());
    for (std::int64_t step = 0; step <= 25; ++step) {
      if (step % cadence < 3) expected.push_back(step);
    }
    CHECK(seen == expected);
  }
}

TEST_CASE("bursts see what a shadow sees that always looks", "[shadow]") {
  Simulation<double> simulation = field();
  auto& always = simulation.every(1, ShadowHamiltonian<>({4, 12}));
  auto& bursts = simulation.every(50, ShadowHamiltonian<>({4, 12}));
  REQUIRE(simulation.run(506).ok());  // the end of the burst at 500
  CHECK(always.values() == bursts.values());
  CHECK(bursts.report().samples == 11);
  CHECK(always.report().samples == 501);
}

TEST_CASE("a corrector does not disturb the shadow: it is that of the composed map, from the first step on",
          "[shadow]") {
  Scheme processed = schemes::verlet;
  processed.before.push_back({'B', Quad(0.05)});
  processed.before.push_back({'A', Quad(0.1)});
  processed.after.push_back({'A', Quad(-0.1)});
  processed.after.push_back({'B', Quad(-0.05)});
  const auto shadow = test::shadow_of(compose(test::kinetic_potential(test::HenonHeilesField{}), processed),
                                      test::henon_heiles_start(), 0.1, 100, {4, 8, 12, 16});
  CHECK(shadow.report().samples == 93);
  CHECK(shadow.fluctuation(2) < 1e-13);
}

TEST_CASE("an edit begins a new window", "[shadow]") {
  Simulation<double> simulation = field();
  auto& shadow = simulation.every(1, ShadowHamiltonian<>({4}));
  REQUIRE(simulation.run(20).ok());
  CHECK(shadow.report().samples == 19);
  simulation.edit([](ParticleSystem<double>& s) { s.velocities().set(0, {0.3, 0.1, 0}); });
  REQUIRE(simulation.run(2).ok());
  CHECK(shadow.report().samples == 19);  // steps 21 and 22: one point short of a window
  REQUIRE(simulation.run(1).ok());
  CHECK(shadow.report().samples == 20);
}

TEST_CASE("runs that keep no shadow are refused by name", "[shadow]") {
  const auto attach = [](auto hamiltonian, const Scheme& scheme) {
    Simulation<double> simulation(test::henon_heiles_start(), compose(std::move(hamiltonian), scheme), 0.1);
    simulation.every(1, ShadowHamiltonian<>());
  };
  CHECK_THROWS_WITH(
      attach(test::damped(test::kinetic_potential(HarmonicField{.k = 1}), LinearDrag{.rate = 0.1}), schemes::verlet),
      "monitor 'shadow_hamiltonian' needs the action of every step: a force of this run is dissipative, so its motion "
      "has no action");
  CHECK_THROWS_WITH(
      attach(test::kinetic_potential(OscillatingField{.acceleration = {1, 0, 0}, .omega = 2}), schemes::verlet),
      "monitor 'shadow_hamiltonian' needs the action of every step: a force of this run depends on time, so no energy "
      "is conserved, not even the exact one");
  Simulation<double> simulation = field();
  CHECK_THROWS_WITH(simulation.every_wall(1, ShadowHamiltonian<>()), Contains("attach it by steps, not by wall time"));
}

TEST_CASE("orders that are none are refused", "[shadow]") {
  CHECK_THROWS_WITH(ShadowHamiltonian<>({3}), Contains("even numbers from 2 to 40, ascending, are expected"));
  CHECK_THROWS_WITH(ShadowHamiltonian<>({4, 4}), Contains("even numbers from 2 to 40, ascending, are expected"));
  CHECK_THROWS_WITH(ShadowHamiltonian<>({42}), Contains("even numbers from 2 to 40, ascending, are expected"));
  CHECK_THROWS_WITH(ShadowHamiltonian<>(std::vector<std::int64_t>{}), Contains("is an empty list"));
}

/// Tracers in lanes: many steps at once end as step by step, whatever happens on the way.

#include "engine/simulation.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/integrators/random_planets.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/settings.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace noether {
namespace {

constexpr Coordinates coordinates_in_lanes[] = {Coordinates::jacobi, Coordinates::democratic};

Simulation<double> run_of(const ParticleSystem<double>& s, Coordinates coordinates, double dt,
                          CompositionOptions options = {}) {
  return Simulation<double>(s,
                            Composition<AnyHamiltonian<double>>(test::wisdom_holman({.coordinates = coordinates}),
                                                                schemes::verlet_aba, options),
                            dt);
}

}  // namespace

TEST_CASE("tracers go in lanes wherever planets do, at every place among them", "[wisdom_holman]") {
  std::mt19937_64 random(3);
  auto s = test::random_planets(5, random, true, 100);
  for (const Coordinates coordinates : coordinates_in_lanes) {
    auto particles = s;
    WisdomHolman<double> lanes({.coordinates = coordinates});
    lanes.bind(particles);
    CHECK(lanes.lanes().bound());
    CHECK_FALSE(lanes.tracers().empty());
  }
  auto run = run_of(s, Coordinates::jacobi, 2.0);
  REQUIRE(run.run(7).ok());
  CHECK(run.evaluations().kepler == 7 * 105);
}

TEST_CASE("hundreds of steps at once have the bits of one after the other", "[wisdom_holman][determinism]") {
  std::mt19937_64 random(4);
  constexpr std::int64_t steps = 150;  // more than tracers are taken along at once
  for (const Coordinates coordinates : coordinates_in_lanes) {
    for (const int planets : {2, 9, 70}) {  // of 70 the path has so many numbers that it is one of few steps
      const auto s = test::random_planets(planets, random, true, 70);
      for (const CompositionOptions& options : {CompositionOptions{}, CompositionOptions{.compensated = true}}) {
        auto whole = run_of(s, coordinates, 2.0, options), parts = run_of(s, coordinates, 2.0, options);
        REQUIRE(whole.run(steps).ok());
        for (std::int64_t n = 0; n < steps; ++n) REQUIRE(parts.run(1).ok());
        CAPTURE(planets, static_cast<int>(coordinates), options.compensated);
        CHECK(test::same_bits(whole.particles(), parts.particles()));
        CHECK(whole.evaluations().kepler == parts.evaluations().kepler);
        CHECK(whole.evaluations().force == parts.evaluations().force);
      }
    }
  }
}

TEST_CASE("a tracer whose arc is not found ends the run at its step for all", "[wisdom_holman]") {
  std::mt19937_64 random(6);
  for (const Coordinates coordinates : coordinates_in_lanes) {
    auto s = test::random_planets(3, random, true, 80);
    // Its distance leaves the range of doubles after some steps.
    s.add("lost", 0, {0, 1e306, 0}, {0, 1e307, 0});
    for (const CompositionOptions& options : {CompositionOptions{}, CompositionOptions{.compensated = true}}) {
      auto bound = s;
      WisdomHolman<double> splitting({.coordinates = coordinates});
      splitting.bind(bound);
      REQUIRE(splitting.lanes().bound());
      auto whole = run_of(s, coordinates, 1.0, options), parts = run_of(s, coordinates, 1.0, options);
      const Outcome end = whole.run(100);
      Outcome step;
      std::int64_t n = 0;
      for (; n < 100; ++n) {
        step = parts.run(1);
        if (!step.ok()) break;
      }
      CAPTURE(static_cast<int>(coordinates), options.compensated, n);
      REQUIRE_FALSE(end.ok());
      CHECK((n > 3 && n < 60));
      CHECK(end.kind == step.kind);
      CHECK(end.step == step.step);
      REQUIRE((end.particle && step.particle));
      CHECK(end.particle->name == "lost");
      CHECK(step.particle->name == "lost");
      CHECK(test::same_bits(whole.particles(), parts.particles()));
      CHECK(whole.evaluations().kepler == parts.evaluations().kepler);
    }
  }
}

TEST_CASE("encounters of tracers are noted as letter by letter, in both directions of time and for any division",
          "[encounter]") {
  for (const Coordinates coordinates : coordinates_in_lanes) {
    for (const double dt : {0.05, -0.05}) {
      ParticleSystem<double> s;
      s.add("star", 1, {0, 0, 0}, {0, 0, 0});
      s.add("planet", 1e-4, {1, 0, 0}, {0, 1, 0});
      s.add("far", 1e-4, {0, 5, 0}, {-std::sqrt(0.2), 0, 0});
      for (int k = 0; k < 90; ++k) {  // the nearer to the planet's orbit, the later they meet it
        const double r = 1.05 + 0.001 * k, angle = (dt > 0 ? 1 : -1) * (0.02 * k + 0.3), v = 1 / std::sqrt(r);
        s.add("dust " + std::to_string(k), 0, {r * std::cos(angle), r * std::sin(angle), 0},
              {-v * std::sin(angle), v * std::cos(angle), 0});
      }
      const auto seen = [&](const AnyHamiltonian<double>& hamiltonian, std::int64_t at_once) {
        Simulation<double> run(s, Composition<AnyHamiltonian<double>>(hamiltonian, schemes::verlet), dt);
        for (std::int64_t n = 0; n < 600; n += at_once) REQUIRE(run.run(at_once).ok());
        const auto found = run.evaluations().encounter;
        REQUIRE(found.has_value());
        return *found;
      };
      const WisdomHolmanOptions options{.G = 1, .coordinates = coordinates};
      const Encounter lanes = seen(test::wisdom_holman(options), 600);
      const Encounter letters = seen(test::wisdom_holman(options, test::no_field), 600);
      CAPTURE(static_cast<int>(coordinates), dt, lanes.hill_radii, letters.hill_radii, lanes.since, lanes.time);
      CHECK(lanes.first == letters.first);
      CHECK(lanes.second == letters.second);
      CHECK(lanes.since == letters.since);
      CHECK(lanes.time == letters.time);
      CHECK(lanes.since != lanes.time);
      CHECK(std::fabs(lanes.hill_radii / letters.hill_radii - 1) < 1e-6);
      for (const std::int64_t at_once : {1, 8}) {
        const Encounter parts = seen(test::wisdom_holman(options), at_once);
        CHECK(parts.first == lanes.first);
        CHECK(parts.second == lanes.second);
        CHECK(parts.since == lanes.since);
        CHECK(parts.time == lanes.time);
        CHECK(parts.hill_radii == lanes.hill_radii);
      }
    }
  }
}

TEST_CASE("a tracer has the same bits alone and beside others, however far these go in a step", "[wisdom_holman]") {
  std::mt19937_64 random(9);
  for (const Coordinates coordinates : coordinates_in_lanes) {
    int apart = 0;
    for (int trial = 0; trial < 20; ++trial) {
      const auto s = test::random_planets(3, random, false, 8);
      const double dt = 5 + trial;  // some pass their pericenter in a step
      auto all = run_of(s, coordinates, dt);
      const Outcome end = all.run(20);
      for (Index one = 4; one < s.size(); ++one) {
        ParticleSystem<double> alone(s.units());
        for (Index i = 0; i < 4; ++i) alone.add(s.name(i), s.masses()[i], s.positions()[i], s.velocities()[i]);
        alone.add(s.name(one), 0, s.positions()[one], s.velocities()[one]);
        auto run = run_of(alone, coordinates, dt);
        if (!end.ok() || !run.run(20).ok()) continue;
        ++apart;
        CAPTURE(trial, one);
        CHECK(norm2(Vec3<double>(run.particles().positions()[4] - all.particles().positions()[one])) == 0);
      }
    }
    CHECK(apart > 100);
  }
}

TEST_CASE("the first encounter of a run stays the first when time turns", "[encounter]") {
  ParticleSystem<double> s;
  s.add("star", 1, {0, 0, 0}, {0, 0, 0});
  s.add("planet", 1e-4, {1, 0, 0}, {0, 1, 0});
  s.add("dust", 0, {1.04, 0, 0}, {0, 0.95, 0});
  s.add("later", 0, {-1.03, 0, 0}, {0, -0.9, 0});
  Simulation<double> run(s, Composition<AnyHamiltonian<double>>(test::wisdom_holman({.G = 1}), schemes::verlet), 0.05);
  REQUIRE(run.run(200).ok());
  REQUIRE(run.evaluations().encounter.has_value());
  const Encounter before = *run.evaluations().encounter;
  run.change_step(-0.01);  // kicks see the same passage at other times, and a nearer one
  REQUIRE(run.run(1000).ok());
  const Encounter after = *run.evaluations().encounter;
  CHECK(after.hill_radii < before.hill_radii);
  CHECK(after.time > before.since);
  CHECK(after.since == before.since);
}

TEST_CASE("predictions of tracers are state, and runs saved without them go on", "[wisdom_holman][restart]") {
  std::mt19937_64 random(8);
  const auto s = test::random_planets(3, random, true, 20);
  const auto begin = [&] { return run_of(s, Coordinates::jacobi, 2.0); };
  auto first = begin(), old = begin(), again = begin();
  REQUIRE(first.run(5).ok());
  SavedRun saved = first.save();
  again.restore(saved);
  int found = 0;
  for (auto& [part, state] : saved.parts) {
    for (auto entry = state.begin(); entry != state.end();) {
      const bool own = entry->first.find("/tracers/") != std::string::npos;
      if (own) CHECK(std::get<std::vector<double>>(entry->second).size() == 20);
      found += own;
      entry = own ? state.erase(entry) : std::next(entry);
    }
  }
  CHECK(found == 1);
  old.restore(saved);
  for (auto* run : {&first, &old, &again}) REQUIRE(run->run(5).ok());
  const auto a = first.particles(), b = old.particles();
  CHECK(test::same_bits(a, again.particles()));
  for (Index i = 0; i < a.size(); ++i) {
    CHECK(std::sqrt(norm2(Vec3<double>(a.positions()[i] - b.positions()[i])) / norm2(a.positions()[i])) < 1e-13);
  }
}

}  // namespace noether

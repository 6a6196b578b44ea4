#include "monitors/orbital_monitors.hpp"

#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace noether {
namespace {

/// A sun of mass 1 and a planet on the orbit of these elements, G = 1.
template <class Real> ParticleSystem<Real> planet(const OrbitalElements<Real>& o, double mass = 0.25) {
  ParticleSystem<Real> s;
  const auto [x, v] = state_from_elements<Real>(o, Real(1 + mass));
  s.add("sun", Real(1), Vec3<Real>::Zero(), Vec3<Real>::Zero());
  s.add("planet", Real(mass), x, v);
  return s;
}

template <class Real> Simulation<Real> orbits_of(ParticleSystem<Real> s, double dt) {
  return Simulation<Real>(std::move(s), compose(test::kinetic_potential<Real>(Gravity{}), schemes::yoshida_8), dt);
}

}  // namespace

TEMPLATE_TEST_CASE("elements refer to particle 0 and stay on a Kepler orbit", "[orbital_monitors]", double, Quad) {
  using Real = TestType;
  const OrbitalElements<Real> o{Real(1.25), Real(0.25), Real(0.5), Real(1), Real(2), Real(3)};
  auto sim = orbits_of(planet<Real>(o), 0.01);
  auto& elements = sim.every(100, Elements{});
  CHECK(sim.run(1000).ok());
  const OrbitalElements<double> now = elements.of(1);
  const double motion = std::sqrt(1.25 / (1.25 * 1.25 * 1.25));
  CHECK(std::abs(now.a - 1.25) < 1e-12);
  CHECK(std::abs(now.e - 0.25) < 1e-12);
  CHECK(std::abs(now.inc - 0.5) < 1e-12);
  CHECK(std::abs(now.Omega - 1) < 1e-12);
  CHECK(std::abs(now.omega - 2) < 1e-11);
  CHECK(std::abs(now.M - std::fmod(3 + 10 * motion, 2 * std::numbers::pi)) < 1e-11);
}

TEST_CASE("the series of elements has one row per particle and none for the primary", "[orbital_monitors]") {
  auto sim = orbits_of(planet<double>({1, 0.5, 0, 0, 0, 0}), 0.01);
  auto& elements = sim.every(1, Elements{});
  CHECK(sim.run(0).ok());
  const std::vector<Series> series = elements.series();
  REQUIRE(series.size() == 1);
  CHECK(series[0].name == "value");
  CHECK(series[0].shape == std::vector<Index>{2, 6});
  REQUIRE(series[0].values.size() == 12);
  for (std::size_t k = 0; k < 6; ++k) CHECK(std::isnan(series[0].values[k]));
  CHECK(std::abs(series[0].values[6] - 1) < 1e-15);
  CHECK(elements.report().samples == 1);
  CHECK_THROWS_AS(elements.of(2), std::out_of_range);
}

TEST_CASE("elements take a constant of gravitation of their own", "[orbital_monitors]") {
  auto sim = orbits_of(planet<double>({1, 0.5, 0, 0, 0, std::numbers::pi}), 0.01);
  auto& own = sim.every(1, Elements{4.0});
  CHECK(sim.run(0).ok());
  // At the apocenter r = 3/2, v^2 = mu (2/r - 1); with 4 mu the axis is 1 / (2/r - v^2/(4 mu)).
  CHECK(std::abs(own.of(1).a - 1 / (4.0 / 3 - 1.0 / 12)) < 1e-14);
}

TEMPLATE_TEST_CASE("a pericenter between two looks is found, and when it was", "[orbital_monitors]", double, Quad) {
  using Real = TestType;
  // The pericenter lies at M = 2 pi; the looks are at M = 5.5, 5.9, 6.3, 6.7: never at it.
  const OrbitalElements<Real> o{Real(1), Real(0.25), Real(0), Real(0), Real(0), Real(5.5)};
  const double distance_error[] = {1e-5, 2e-7};
  const double time_error[] = {1e-4, 1e-5};
  int refinement = 0;
  for (const int steps : {40, 20}) {
    auto sim = orbits_of(planet<Real>(o, 0), 0.01);
    auto& closest = sim.every(steps, ClosestApproach{});
    CHECK(sim.run(120).ok());
    CHECK(std::abs(closest.distance() - 0.75) < distance_error[refinement]);
    CHECK(std::abs(closest.at_time() - (2 * std::numbers::pi - 5.5)) < time_error[refinement]);
    CHECK(closest.pair() == std::vector<std::int64_t>{0, 1});
    ++refinement;
  }
}

TEST_CASE("the smallest distance is the smallest of the whole run, not the last", "[orbital_monitors]") {
  auto sim = orbits_of(planet<double>({1, 0.5, 0, 0, 0, -0.5}, 0), 0.01);
  auto& closest = sim.every(10, ClosestApproach{});
  CHECK(sim.run(300).ok());
  CHECK(std::abs(closest.distance() - 0.5) < 1e-6);
  const MonitorReport report = closest.report();
  CHECK(*report.last == closest.distance());
  CHECK(*report.first > 0.5);
  CHECK(report.samples == 31);
  CHECK(report.note.rfind("sun and planet at time 0.5", 0) == 0);
  const std::vector<Series> series = closest.series();
  CHECK(series[0].name == "distance");
  CHECK(series[1].values == std::vector<double>{0, 1});
  CHECK(series[2].values[0] == closest.at_time());
}

TEST_CASE("looks too far apart for an approach say so, and count only what was seen", "[orbital_monitors]") {
  auto seldom = orbits_of(planet<double>({1, 0.9, 0, 0, 0, -0.5}, 0), 0.001);
  auto often = orbits_of(planet<double>({1, 0.9, 0, 0, 0, -0.5}, 0), 0.001);
  auto& guess = seldom.every(1000, ClosestApproach{});
  auto& known = often.every(1, ClosestApproach{});
  CHECK(seldom.run(1000).ok());
  CHECK(often.run(1000).ok());
  CHECK(guess.distance() > 0.5);
  CHECK(guess.unresolved() == 1);
  CHECK(guess.report().note.find("; 1 times a pair may have been nearer between two looks") != std::string::npos);
  CHECK(std::abs(known.distance() - 0.1) < 1e-5);
  CHECK(known.unresolved() == 0);
}

TEST_CASE("tracers come near massive bodies, never near each other", "[orbital_monitors]") {
  ParticleSystem<double> s;
  s.add("sun", 1, {0, 0, 0}, {0, 0, 0});
  s.add("dust", 0, {1, 0, 0}, {0, 1, 0});
  s.add("more dust", 0, {1.001, 0, 0}, {0, 1, 0});
  auto sim = orbits_of(std::move(s), 0.01);
  auto& closest = sim.every(1, ClosestApproach{});
  CHECK(sim.run(0).ok());
  CHECK(closest.distance() == 1);
}

TEST_CASE("a single particle has no closest approach and reports none", "[orbital_monitors]") {
  ParticleSystem<double> s;
  s.add("alone", 1, {0, 0, 0}, {1, 0, 0});
  auto sim = orbits_of(std::move(s), 0.5);
  auto& closest = sim.every(1, ClosestApproach{});
  CHECK(sim.run(2).ok());
  CHECK(std::isinf(closest.distance()));
  CHECK(!closest.report().last);
  CHECK(closest.series()[1].values == std::vector<double>{-1, -1});
}

TEST_CASE("orbital monitors report the same after save and load as without", "[orbital_monitors][restart]") {
  const auto start = [] { return orbits_of(planet<double>({1, 0.5, 0.1, 0.2, 0.3, 5.5}), 0.01); };
  auto whole = start(), first = start(), second = start();
  std::vector<ClosestApproach*> closest;
  std::vector<Elements*> elements;
  for (auto* sim : {&whole, &first, &second}) {
    closest.push_back(&sim->every(20, ClosestApproach{}));
    elements.push_back(&sim->every(20, Elements{}));
  }
  CHECK(whole.run(200).ok());
  CHECK(first.run(75).ok());  // the pericenter is passed at 78: the path begins before the restart and ends after it
  second.restore(first.save());
  CHECK(second.run(125).ok());
  CHECK(closest[2]->distance() == closest[0]->distance());
  CHECK(closest[2]->at_time() == closest[0]->at_time());
  CHECK(closest[2]->report().note == closest[0]->report().note);
  CHECK(closest[2]->report().first == closest[0]->report().first);
  CHECK(elements[2]->report().samples == elements[0]->report().samples);
  CHECK(elements[2]->of(1).M == elements[0]->of(1).M);
}

}  // namespace noether

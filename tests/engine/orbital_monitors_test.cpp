#include "monitors/orbital_monitors.hpp"

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_methods.hpp"
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

TEST_CASE("elements are about the body that is named, wherever it stands", "[orbital_monitors]") {
  const OrbitalElements<double> o{1, 0.5, 0.1, 0.2, 0.3, 0.4};
  auto s = planet<double>(o);
  s.add("moon", 0, s.positions()[1] + Vec3<double>(0.01, 0, 0), s.velocities()[1] + Vec3<double>(0, 5, 0));
  const auto start = [&](std::vector<Index> order) {
    ParticleSystem<double> t;
    for (const Index i : order) t.add(s.name(i), s.masses()[i], s.positions()[i], s.velocities()[i]);
    return orbits_of(std::move(t), 0.01);
  };
  const auto note = [](const Elements& elements) { return elements.report().note; };
  auto sun_first = start({0, 1, 2}), planet_first = start({1, 0, 2}), moon_last = start({1, 2, 0});
  const auto& usual = sun_first.every(1, Elements{});
  const auto& wrong = planet_first.every(1, Elements{});
  Elements about_sun, about_planet;
  about_sun.about = "sun";
  about_planet.about = "planet";
  const auto& right = moon_last.every(1, about_sun);
  const auto& of_moon = sun_first.every(1, about_planet);
  for (auto* sim : {&sun_first, &planet_first, &moon_last}) CHECK(sim->run(0).ok());
  CHECK(std::abs(usual.of(1).a - 1) < 1e-14);
  CHECK(std::abs(right.of(0).a - 1) < 1e-14);
  CHECK(std::abs(right.of(0).e - 0.5) < 1e-14);
  CHECK(std::isnan(right.of(2).a));
  // v^2 = mu (2/r - 1/a), mu = 1/4
  CHECK(std::abs(of_moon.of(2).a - 1 / (2 / 0.01 - 25 / 0.25)) < 1e-12);
  CHECK(note(usual) == "six numbers for each particle: see the trajectory file");
  CHECK(note(right) == note(usual));
  CHECK(note(wrong) == note(usual) +
                           "; they are about 'planet', which comes first, and 'sun' has more mass: give about = "
                           "\"sun\"");
  Elements nobody;
  nobody.about = "sum";
  CHECK_THROWS_WITH(sun_first.every(1, nobody), "about = \"sum\" is not a particle; did you mean 'sun'?");
  nobody.about = "moon";
  CHECK_THROWS_WITH(sun_first.every(1, nobody),
                    "elements are about 'moon', whose mass is 0; give about = \"NAME\" of a body that has mass");
}

TEST_CASE("what orbital monitors kept later is no matter to runs that were saved before",
          "[orbital_monitors][restart]") {
  auto sim = orbits_of(planet<double>({1, 0.5, 0.1, 0.2, 0.3, 5.5}), 0.01);
  sim.every(20, ClosestApproach{});
  sim.every(20, Elements{});
  CHECK(sim.run(40).ok());
  SavedRun saved = sim.save();
  int taken = 0;
  for (auto& [name, part] : saved.parts) {
    taken += static_cast<int>(std::erase_if(part, [](const auto& one) {
      const std::string& key = one.first;
      return key.ends_with("tracers") || key.ends_with("primary") || key.ends_with("heaviest");
    }));
  }
  CHECK(taken == 3);
  auto other = orbits_of(planet<double>({1, 0.5, 0.1, 0.2, 0.3, 5.5}), 0.01);
  auto& closest = other.every(20, ClosestApproach{});
  other.every(20, Elements{});
  other.restore(saved);
  CHECK(other.run(40).ok());
  CHECK(closest.report().samples == 5);
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

TEST_CASE("between looks too far apart for a path the pericenter of a pair is found", "[orbital_monitors]") {
  auto seldom = orbits_of(planet<double>({1, 0.9, 0, 0, 0, -0.5}, 0), 0.001);
  auto often = orbits_of(planet<double>({1, 0.9, 0, 0, 0, -0.5}, 0), 0.001);
  auto& rare = seldom.every(1000, ClosestApproach{});
  auto& known = often.every(1, ClosestApproach{});
  CHECK(seldom.run(1000).ok());
  CHECK(often.run(1000).ok());
  for (const ClosestApproach* closest : {&rare, &known}) {
    CHECK(std::abs(closest->distance() - 0.1) < 1e-5);
    CHECK(std::abs(closest->at_time() - 0.5) < 1e-5);
    CHECK(closest->unresolved() == 0);
  }
}

TEST_CASE("looks too far apart for an approach say so, and count only what was seen", "[orbital_monitors]") {
  ParticleSystem<double> s;
  s.add("rock", 1, {0, 0, 0}, {0, 0, 0});
  s.add("ball", 1, {1, 0.01, 0}, {0, 0, 0});  // swings through the middle
  const auto runs = [&] {
    return Simulation<double>(s, compose(test::kinetic_potential(HarmonicField{.k = 1}), schemes::yoshida_8), 0.01);
  };
  auto seldom = runs(), often = runs();
  auto& guess = seldom.every(230, ClosestApproach{});
  auto& known = often.every(1, ClosestApproach{});
  CHECK(seldom.run(230).ok());
  CHECK(often.run(230).ok());
  CHECK(guess.distance() > 0.5);
  CHECK(guess.unresolved() == 1);
  CHECK(guess.report().note.find("; 1 times a pair may have come nearer between two samples") != std::string::npos);
  CHECK(known.distance() < 0.01);
}

TEST_CASE("the end of a run is looked at whatever the cadence, and a run that goes on does not notice",
          "[orbital_monitors]") {
  const auto start = [] { return orbits_of(planet<double>({1, 0.5, 0, 0, 0, -0.5}, 0), 0.01); };
  auto cut = start(), whole = start();
  auto& closest = cut.every(40, ClosestApproach{});
  auto& uncut = whole.every(40, ClosestApproach{});
  CHECK(cut.run(75).ok());                           // the pericenter is passed at 50, the last look was at 40
  CHECK(std::abs(closest.distance() - 0.5) < 1e-3);  // by the path from 40 to 75
  CHECK(closest.report().samples == 2);
  CHECK(closest.report().last == closest.distance());
  CHECK(cut.run(45).ok());
  CHECK(whole.run(120).ok());
  CHECK(closest.distance() == uncut.distance());
  CHECK(closest.at_time() == uncut.at_time());
  CHECK(closest.report().samples == 4);
  // Where steps are the method's own the run ends between two of them.
  Simulation<double> adaptive(
      planet<double>({1, 0.5, 0, 0, 0, -0.5}, 0),
      test::classical_over(Gravity{}, {methods::find("dop853"), {.rtol = 1e-10, .atol = 1e-10}}));
  auto& by_steps = adaptive.every(1, ClosestApproach{});
  CHECK(adaptive.run_until(0.5).ok());
  CHECK(std::abs(by_steps.distance() - 0.5) < 1e-8);
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
  CHECK(closest.report().note == "sun and dust at time 0; pairs of the 2 tracers, whose mass is 0, are left out");
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

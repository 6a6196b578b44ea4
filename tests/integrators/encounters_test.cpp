/// Encounters that a Wisdom-Holman splitting should not meet: seen at the kicks, and state of the run.

#include "engine/simulation.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/wisdom_holman.hpp"
#include "monitors/monitors.hpp"
#include "scene/warnings.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace noether {
namespace {

constexpr Coordinates in_turn[] = {Coordinates::jacobi, Coordinates::democratic, Coordinates::whds,
                                   Coordinates::barycentric};

/// Two planets of 1e-5 on circles at 1 and 1.04 about a star, and a tracer that passes the second one.
ParticleSystem<double> crowd() {
  ParticleSystem<double> s;
  s.add("star", 1, {0, 0, 0}, {0, 0, 0});
  s.add("inner", 1e-5, {1, 0, 0}, {0, 1, 0});
  const double outer = 1.04, angle = 0.05, speed = 1 / std::sqrt(outer);
  s.add("outer", 1e-5, {outer * std::cos(angle), outer * std::sin(angle), 0},
        {-speed * std::sin(angle), speed * std::cos(angle), 0});
  s.add("dust", 0, {0, 0.5, 0}, {-std::sqrt(2.0), 0, 0});
  return s;
}

Simulation<double> meeting(Coordinates coordinates) {
  return Simulation<double>(crowd(),
                            compose(test::wisdom_holman({.G = 1, .coordinates = coordinates}), schemes::verlet), 0.05);
}

/// The smallest distance of the two planets over their Hill radius, at all whole steps, which kicks of Verlet see.
double closest(Simulation<double>& simulation, std::int64_t steps) {
  double least = 1e300;
  for (std::int64_t n = 0; n < steps; ++n) {
    REQUIRE(simulation.run(1).ok());
    const auto& x = simulation.particles().positions();
    const double apart = std::sqrt(norm2(Vec3<double>(x[2] - x[1])));
    const double nearer2 = std::min(norm2(Vec3<double>(x[1] - x[0])), norm2(Vec3<double>(x[2] - x[0])));
    const double hill = std::cbrt(2e-5 / 3) * std::sqrt(nearer2);
    least = std::min(least, apart / hill);
  }
  return least;
}

TEST_CASE("the closest meeting of two planets is kept, with their ids and its time", "[encounter]") {
  for (const Coordinates coordinates : in_turn) {
    CAPTURE(static_cast<int>(coordinates));
    auto simulation = meeting(coordinates);
    const double least = closest(simulation, 1500);
    const auto encounter = simulation.evaluations().encounter;
    REQUIRE(encounter.has_value());
    CHECK(least < 2);
    CHECK(std::fabs(encounter->hill_radii / least - 1) < 1e-3);
    CHECK(std::minmax(encounter->first, encounter->second) ==
          std::minmax(simulation.particles().ids()[1], simulation.particles().ids()[2]));
    CHECK(encounter->since < encounter->time);
    CHECK(encounter->since > 0);
    CHECK(encounter->time < 75);
  }
}

TEST_CASE("a tracer near a planet is seen as well, and the outer planets never", "[encounter]") {
  auto s = crowd();
  s.positions().set(3, {1.01, 0.012, 0});  // within 2 Hill radii of the inner planet
  s.velocities().set(3, {0, 1, 0});
  Simulation<double> near(std::move(s), compose(test::wisdom_holman({.G = 1}), schemes::verlet), 0.05);
  REQUIRE(near.run(2).ok());
  REQUIRE(near.evaluations().encounter.has_value());
  CHECK(near.evaluations().encounter->second == near.particles().ids()[3]);
  Simulation<double> quiet(test::planets_with_tracers(30),
                           compose(test::wisdom_holman({.G = test::outer_G}), schemes::verlet_aba), 100.0);
  REQUIRE(quiet.run(500).ok());
  CHECK_FALSE(quiet.evaluations().encounter.has_value());
}

TEST_CASE("bodies that meet in the word before a run only have not met", "[encounter][corrector]") {
  // A tracer on the other way round passes the planet, 1.5 Hill radii outside, when the word before the run has drifted
  // by eight nodes.
  const double dt = 0.05, node = std::sqrt(7.0 / 40), r = 1.0224, speed = 1 / std::sqrt(r);
  const double angle = (1 + speed / r) * 8 * node * dt;
  for (const Coordinates coordinates : in_turn) {
    CAPTURE(static_cast<int>(coordinates));
    const auto seen = [&](std::int64_t corrector, std::int64_t steps) {
      ParticleSystem<double> s;
      s.add("star", 1, {0, 0, 0}, {0, 0, 0});
      s.add("planet", 1e-5, {1, 0, 0}, {0, 1, 0});
      s.add("dust", 0, {r * std::cos(angle), r * std::sin(angle), 0},
            {speed * std::sin(angle), -speed * std::cos(angle), 0});
      Simulation<double> run(std::move(s),
                             compose(test::wisdom_holman({.G = 1, .coordinates = coordinates}), schemes::verlet_aba,
                                     {.corrector = corrector}),
                             dt);
      REQUIRE(run.run(steps).ok());
      return run.evaluations().encounter.has_value();
    };
    CHECK_FALSE(seen(17, 1));
    CHECK(seen(17, 6));
    CHECK(seen(0, 6));
  }
}

TEST_CASE("the place to which a lazy kick looks ahead is none where bodies meet", "[encounter][kernel]") {
  // Two planets a little more than two Hill radii from each other, which their attraction would bring nearer.
  const double m = 1e-3, hill = std::cbrt(2 * m / 3);
  const auto seen = [&](double hill_radii) {
    ParticleSystem<double> s;
    s.add("star", 1, {0, 0, 0}, {0, 0, 0});
    s.add("inner", m, {1, 0, 0}, {0, 1, 0});
    s.add("outer", m, {1 + hill_radii * hill, 0, 0}, {0, 0.9, 0});
    s.clock() = Clock<double>::fixed(0, 0.5);
    WisdomHolman<double> arcs({.G = 1});
    arcs.bind(s);
    arcs.open(s);
    s.phase().opened = true;
    arcs.flow('L', s, 0.5);
    return arcs.evaluations().encounter.has_value();
  };
  CHECK_FALSE(seen(2.005));
  CHECK(seen(1.995));
}

TEST_CASE("a companion star is no encounter, wherever it stands in the file", "[encounter]") {
  const auto body = [](double distance) { return Vec3<double>(distance, 0, 0); };
  const auto speed = [](double distance, double mass) { return Vec3<double>(0, std::sqrt(mass / distance), 0); };
  // A planet about the inner two of three, and one about the inner star of two, each listed before and after the star.
  for (const auto& [star, planet] : {std::pair(1.0, 10.0), std::pair(20.0, 1.0)}) {
    for (const bool star_first : {true, false}) {
      CAPTURE(star, planet, star_first);
      ParticleSystem<double> s;
      s.add("primary", 1, {0, 0, 0}, {0, 0, 0});
      if (star_first) s.add("star", 1, body(star), speed(star, 2));
      s.add("planet", 1e-6, body(planet), speed(planet, planet > star ? 2 : 1));
      if (!star_first) s.add("star", 1, body(star), speed(star, 2));
      Simulation<double> run(std::move(s), compose(test::wisdom_holman({.G = 1}), schemes::verlet), 0.01);
      REQUIRE(run.run(50).ok());
      CHECK_FALSE(run.evaluations().encounter.has_value());
    }
  }
}

TEST_CASE("an encounter does not depend on the order of the bodies, and an edit does not forget it", "[encounter]") {
  const auto seen = [](bool outer_first) {
    ParticleSystem<double> s;
    s.add("star", 1, {0, 0, 0}, {0, 0, 0});
    if (outer_first) s.add("outer", 1e-5, {1.02, 0, 0}, {0, 1, 0});
    s.add("inner", 1e-5, {1, 0, 0}, {0, 1, 0});
    if (!outer_first) s.add("outer", 1e-5, {1.02, 0, 0}, {0, 1, 0});
    Simulation<double> run(std::move(s), compose(test::wisdom_holman({.G = 1}), schemes::verlet), 0.001);
    REQUIRE(run.run(1).ok());
    run.edit([](ParticleSystem<double>& p) { p.positions().set(2, Vec3<double>(0, 3, 0)); });
    REQUIRE(run.run(1).ok());
    return run.evaluations().encounter;
  };
  const auto a = seen(true), b = seen(false);
  REQUIRE((a.has_value() && b.has_value()));
  CHECK(std::fabs(a->hill_radii / b->hill_radii - 1) < 1e-9);
  CHECK(std::fabs(a->hill_radii - 0.02 / std::cbrt(2e-5 / 3)) < 1e-3);
}

TEST_CASE("an encounter is state of the run, and observers do not add to it", "[encounter][restart]") {
  auto whole = meeting(Coordinates::jacobi), first = meeting(Coordinates::jacobi),
       second = meeting(Coordinates::jacobi);
  whole.every(1, Energy());
  REQUIRE(whole.run(1500).ok());
  REQUIRE(first.run(900).ok());
  second.restore(first.save());
  REQUIRE(second.run(600).ok());
  const auto a = whole.evaluations().encounter, b = second.evaluations().encounter;
  REQUIRE((a.has_value() && b.has_value()));
  CHECK(a->hill_radii == b->hill_radii);
  CHECK(a->time == b->time);
  CHECK(a->since == b->since);
  CHECK(a->first == b->first);
}

TEST_CASE("a run says in one line who met whom, when, and how closely", "[encounter]") {
  const auto s = crowd();
  const Encounter once{.first = s.ids()[1], .second = s.ids()[2], .hill_radii = 0.4213, .time = 12.5, .since = 12.5};
  CHECK(
      warning_of(once, "wisdom_holman", s, unit_system("reduced")) ==
      "'inner' and 'outer' came within 0.42 Hill radii of each other at time 12.5; wisdom_holman does not follow such "
      "encounters, so use a method whose steps shrink in them, such as 'gauss_8'");
  Encounter later = once;
  later.since = 3.25;
  later.second = 77;
  CHECK(
      warning_of(later, "democrat", s, unit_system("solar")) ==
      "'inner' and a body that is gone (id 77) came within 0.42 Hill radii of each other at time 12.5 day, and bodies "
      "within 2 for the first time at time 3.25 day; democrat does not follow such encounters, so use a method "
      "whose steps shrink in them, such as 'gauss_8'");
}

TEST_CASE("a run says how many steps had bodies too near to each other for their method", "[encounter]") {
  CHECK(warning_of(Evaluations{.unsettled = 1}, "encke_gauss_8") ==
        "in 1 step of 'encke_gauss_8' two bodies were so near to each other that doubles do not tell their pull well "
        "enough for errors below 1e-18; use 'wide_gauss_8'");
  CHECK(warning_of(Evaluations{.unsettled = 20}, "encke_gauss_8").starts_with("in 20 steps of 'encke_gauss_8'"));
}

}  // namespace
}  // namespace noether

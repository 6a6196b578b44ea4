/// Hard spheres in a shearing sheet: contacts at their times, none missed and none twice, and what is kept in them.

#include "forces/hard_spheres.hpp"
#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/shearing_sheet.hpp"
#include "integrators/sphere_contacts.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/contacts_by_pairs.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/ring_spheres.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace noether {
namespace {

using test::deepest_overlap;
using test::Place;
using test::searched_run;
using test::SearchedRun;
using test::sheet_of_spheres;
using test::total_contacts;

}  // namespace

TEST_CASE("contacts of spheres are those of a search by pairs", "[integrators][hard_spheres]") {
  const SearchedRun run =
      searched_run(test::patch({.count = 40, .thickness = 4, .speed = 2}), {.restitution = 0.7}, 0.1, 60);
  INFO(run.contacts << " contacts");
  CHECK(run.wrong_steps == 0);
  CHECK(run.contacts > 100);
  CHECK(run.worst <= 1e-10);
}

TEST_CASE("two spheres of a sheet meet where their epicycles say", "[integrators][hard_spheres]") {
  // In open space: the time of the contact by halving in 113 bits, and a rebound by hand; a tracer is a sphere too.
  const HardSpheres ice{.restitution = 0.32, .restitution_exponent = -0.234, .restitution_speed = 0.01};
  for (const double mass : {0.5, 0.0, 3.0}) {
    ParticleSystem<double> s(unit_system("reduced"));
    s.add("inner", mass, {-0.5, 1.0, 0.1}, {0.1, 0.5, 0.05});
    s.add("outer", 0.5, {0.25, 2.0, -0.1}, {-0.2, -0.75, 0});
    s.add_column<BodyRadius>()[0] = 0.25;
    s.column<BodyRadius>()[1] = 0.125;
    const double h = 1.5, touch = 0.375;
    const auto at = [&](double t, Index i) {
      return Place{std::as_const(s).positions()[i], std::as_const(s).velocities()[i]}.at(t, 1, 0.5);
    };
    const auto gap = [&](double t) { return (at(t, 1).x - at(t, 0).x).norm() - touch; };
    double low = 0, high = 0;
    while (gap(high) > 0) high += 1e-3;
    REQUIRE(high < h);
    for (int n = 0; n < 60; ++n) (gap((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
    Place one = at(high, 0), other = at(high, 1);
    const Vec3<double> n = (other.x - one.x).normalized();
    const double approach = (one.v - other.v).dot(n), epsilon = std::min(1.0, 0.32 * std::pow(approach / 0.01, -0.234));
    REQUIRE(epsilon < 0.5);
    const double gain = (1 + epsilon) * approach, share = mass == 0 ? 1 : 0.5 / (mass + 0.5);
    one.v -= share * gain * n;
    other.v += (1 - share) * gain * n;
    one = one.at(h - high, 1, 0.5);
    other = other.at(h - high, 1, 0.5);
    for (const int steps : {1, 10}) {
      INFO("mass " << mass << ", " << steps << " steps");
      const auto found =
          test::run(sheet_of_spheres({.Omega = 1, .Omega_z = 0.5}, ice), schemes::verlet, s, h / steps, steps);
      CHECK((Vec3<double>(found.positions()[0]) - one.x).cwiseAbs().maxCoeff() <= 1e-13);
      CHECK((Vec3<double>(found.positions()[1]) - other.x).cwiseAbs().maxCoeff() <= 1e-13);
      CHECK((Vec3<double>(found.velocities()[0]) - one.v).cwiseAbs().maxCoeff() <= 1e-13);
      CHECK((Vec3<double>(found.velocities()[1]) - other.v).cwiseAbs().maxCoeff() <= 1e-13);
      CHECK(found.column<ContactCount>()[0] == 1);
      CHECK(found.column<ContactCount>()[1] == 1);
      // What was lost is in the column of heat.
      const double reduced = mass * 0.5 / (mass + 0.5),
                   lost = reduced * approach * approach * (1 - epsilon * epsilon) / 2;
      CHECK(std::abs(found.column<ContactHeat>()[0] + found.column<ContactHeat>()[1] - lost) <= 1e-14);
    }
  }
}

TEST_CASE("spheres keep momentum in contacts, elastic ones energy", "[integrators][hard_spheres]") {
  // In open space the energy in the turning frame is that of the start.
  const double h = 0.05;
  const int steps = 400;
  auto s = test::patch({.count = 60, .thickness = 3, .speed = 1});
  const test::SheetMomentum before(s, 1);
  const auto after = test::run(sheet_of_spheres({}, {.restitution = 0.5}), schemes::verlet, s, h, steps);
  CHECK(total_contacts(after) > 300);
  const Vec3<double> error = test::SheetMomentum(after, 1).sum - before.turned(h * steps, 1);
  CHECK(error.cwiseAbs().maxCoeff() <= 1e-12);

  s.set_box(Box::open());
  auto elastic = sheet_of_spheres({}, {.restitution = 1, .minimum_rebound = 1e-12});
  const double energy = elastic.energy(s).total();
  const auto scattered = test::run(elastic, schemes::verlet, s, h, 40);
  CHECK(total_contacts(scattered) > 30);
  CHECK(std::abs(elastic.energy(scattered).total() - energy) <= 1e-12 * std::abs(energy));
  // So monitors tell an error of the energy, of elastic spheres alone.
  CHECK_FALSE(elastic.claims().dissipative);
  CHECK(sheet_of_spheres({}, {.restitution = 0.99}).claims().dissipative);
  const HardSpheres slower{.restitution = 1, .restitution_exponent = -0.1, .restitution_speed = 1};
  CHECK(sheet_of_spheres({}, slower).claims().dissipative);
}

TEST_CASE("spheres have the same bits where a box is cut elsewhere, over threads, cadences and saves",
          "[integrators][hard_spheres]") {
  const HardSpheres law{.restitution = 0.5};
  const auto start = [&](double cut) {
    auto s = test::patch({.count = 300, .edges = {28, 20, 40}, .thickness = 3, .speed = 0.5, .cut = cut});
    return Simulation<double>(std::move(s), compose(sheet_of_spheres({}, law), schemes::verlet_aba), 0.0625);
  };
  const int before = thread_count();
  set_thread_count(1);
  auto alone = start(0);
  REQUIRE(alone.run(48).ok());
  const auto expected = alone.particles();
  CHECK(total_contacts(expected) > 200);
  auto elsewhere = start(9);
  REQUIRE(elsewhere.run(48).ok());
  CHECK((elsewhere.particles().positions().all() == expected.positions().all()));
  CHECK((elsewhere.particles().column<ContactTransport>().all() == expected.column<ContactTransport>().all()));
  for (const int threads : {2, 3}) {
    set_thread_count(threads);
    auto sim = start(0);
    for (const int piece : {1, 20, 27}) {
      REQUIRE(sim.run(piece).ok());
      const auto seen = sim.particles();  // a settled copy
      const SavedRun saved = sim.save();
      sim = start(0);
      sim.restore(saved);
    }
    CHECK((sim.particles().positions().all() == expected.positions().all()));
    CHECK((sim.particles().velocities().all() == expected.velocities().all()));
    CHECK((sim.particles().column<ContactHeat>().all() == expected.column<ContactHeat>().all()));
  }
  set_thread_count(before);
}

TEST_CASE("spheres pressed together come to rest, or say that they pile up; so do those that are too fast",
          "[integrators][hard_spheres]") {
  // Seven that attract each other and lose all of their speed of approach: a heap.
  ParticleSystem<double> s(unit_system("reduced"));
  s.add_column<BodyRadius>();
  for (int k = 0; k < 7; ++k) {
    const double a = 1.0471975511965976 * k;
    s.add("", 1, k == 6 ? Vec3<double>(0, 0, 0) : Vec3<double>(2.1 * std::cos(a), 2.1 * std::sin(a), 0.1 * (k % 3)),
          {0, 0, 0});
    s.column<BodyRadius>()[k] = 1;
  }
  auto heap = sheet_of_spheres({.Omega = 0.05}, {.restitution = 0}, Gravity{.G = 1});
  const auto rested = test::run(heap, schemes::verlet, s, 0.01, 2000);
  double fastest = 0, widest = 0;
  for (Index i = 0; i < rested.size(); ++i) {
    for (Index j = 0; j < i; ++j) {
      const Vec3<double> d = rested.positions()[j] - rested.positions()[i];
      CHECK(d.norm() >= 2 * (1 - 1e-12));
      widest = std::max(widest, d.norm());
      const Vec3<double> u = rested.velocities()[j] - rested.velocities()[i];
      fastest = std::max(fastest, std::abs(u.dot(d) / d.norm()));
    }
  }
  CHECK(widest <= 4.2);
  CHECK(fastest <= 0.1);
  CHECK(total_contacts(rested) > 1000);

  // One sphere on another in the pull towards the middle, with next to no rebound left: a named outcome.
  ParticleSystem<double> two(unit_system("reduced"));
  two.add("lower", 1, {0, 0, -1.0}, {0, 0, 0});
  two.add("upper", 1, {0, 0, 1.0}, {0, 0, 0});
  for (const Index i : {0, 1}) (i == 0 ? two.add_column<BodyRadius>() : two.column<BodyRadius>())[i] = 1;
  Simulation<double> endless(
      two, compose(sheet_of_spheres({}, {.restitution = 0, .minimum_rebound = 1e-30}), schemes::verlet), 0.1);
  const Outcome outcome = endless.run(10);
  CHECK_FALSE(outcome.ok());
  CHECK(outcome.message.find("spheres pile up") != std::string::npos);

  // So fast that they would be looked for without end, in open space and in a box.
  for (const auto& [boxed, speed] : {std::pair(false, 1e300), {true, 1e6}}) {
    CAPTURE(boxed, speed);
    ParticleSystem<double> fast(unit_system("reduced"));
    if (boxed) fast.set_box(Box::periodic({10, 10, 10}));
    fast.add("one", 1, {1, 1, 0}, {0, -1.5, 0});
    fast.add("other", 1, {1, 4, 0}, {speed, -1.5, 0});
    fast.add_column<BodyRadius>().all().setConstant(1);
    Simulation<double> sim(fast, compose(sheet_of_spheres({}, {.restitution = 0.5}), schemes::verlet), 0.1);
    const Outcome seen = sim.run(10);
    CHECK(seen.message.find("so fast that contacts are looked for") != std::string::npos);
  }
}

TEST_CASE("spheres that are none are refused, and others cost nothing", "[integrators][hard_spheres]") {
  const auto refused = [](const HardSpheres& law, ParticleSystem<double> s) {
    auto sheet = sheet_of_spheres({}, law);
    sheet.bind(s);
  };
  const auto s = test::patch({});
  CHECK_THROWS_WITH(refused({.restitution = 1.5}, s),
                    "restitution = 1.5 is not a coefficient of restitution; a number from 0 to 1 is expected");
  CHECK_THROWS_WITH(refused({.restitution = -0.1}, s),
                    "restitution = -0.1 is not a coefficient of restitution; a number from 0 to 1 is expected");
  CHECK_THROWS_WITH(
      refused({.restitution = 0.3, .restitution_exponent = -0.2}, s),
      "restitution_exponent = -0.2 needs the speed at which the coefficient is restitution; give restitution_speed");
  auto negative = s;
  negative.column<BodyRadius>()[3] = -0.5;
  CHECK_THROWS_WITH(refused({}, negative), "the radius of '' is -0.5; 0 or more is expected");
  auto none = s;
  none.column<BodyRadius>().all().setZero();
  CHECK_THROWS_WITH(refused({}, none), "no particle is a sphere; give at least one a radius");
  auto small = s;
  small.set_box(Box::periodic({3, 8, 8}));
  CHECK_THROWS_WITH(refused({}, small), Catch::Contains("could meet two images of another one"));
  ParticleSystem<double> overlapping(unit_system("reduced"));
  overlapping.set_box(Box::periodic({10, 10, 10}));
  overlapping.add("a", 1, {0.25, 0.25, 0}, {0, 0, 0});
  overlapping.add("b", 1, {9.75, 9.75, 0}, {0, 0, 0});
  for (const Index i : {0, 1})
    (i == 0 ? overlapping.add_column<BodyRadius>() : overlapping.column<BodyRadius>())[i] = 0.5;
  CHECK_THROWS_WITH(refused({}, overlapping), Catch::Contains("'a' and 'b' overlap: they are 0.7071"));
  CHECK_THROWS_WITH(with_letter(HardSpheres{}, test::kinetic_potential(Gravity{})),
                    Catch::Contains("hard spheres are those of 'shearing_sheet', not of 'kinetic_potential'"));
  CHECK_THROWS_WITH(compose(sheet_of_spheres({}, {}), schemes::yoshida_4), Catch::Contains("irreversible"));
  CHECK_THROWS_WITH(test::run(sheet_of_spheres({}, {}), schemes::verlet, s, -0.1, 1),
                    "hard spheres cannot go back in time: what they lose is not known; a step above 0 is expected");
  // A sheet that has no spheres has no columns of theirs.
  ParticleSystem<double> points(unit_system("reduced"));
  points.add("", 1, {0, 0, 0}, {0, 0, 0});
  const std::size_t bytes = points.bytes_per_particle();
  CHECK(test::run(test::sheet<double>({}), schemes::verlet, points, 0.1, 2).bytes_per_particle() == bytes);
}

TEST_CASE("no contact of a million is missed", "[integrators][hard_spheres][nightly]") {
  // A thick patch, three spheres deep, over thousands of orbits: after every five steps no two spheres overlap, by a
  // search through all pairs and images. Two that pass each other unseen overlap for several steps.
  Composition<AnyHamiltonian<double>> integrator(sheet_of_spheres({}, {.restitution = 0.5}), schemes::verlet);
  auto raw =
      test::patch({.count = 120, .edges = {12, 10, 60}, .smallest = 0.4, .largest = 0.6, .thickness = 8, .speed = 1});
  raw.clock() = Clock<double>::fixed(0, 0.05);
  integrator.bind(raw);
  auto now = raw;
  double deepest = 0;
  do {
    integrator.advance(raw, {.steps = 5});
    integrator.settle(raw, now, {}, std::nullopt, true);
    deepest = std::max(deepest, deepest_overlap(now, 1));
  } while (total_contacts(now) < 1e6);
  CHECK(deepest <= 1e-10);
}

}  // namespace noether

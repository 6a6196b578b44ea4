/// Departures from Kepler orbits on states of double-doubles: errors below the rounding of doubles, against 113 bits.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/linear_drag.hpp"
#include "forces/oblateness.hpp"
#include "integrators/classical.hpp"
#include "monitors/monitors.hpp"
#include "tests/methods/both_words.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/problems.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace noether;
using namespace noether::test;

namespace {

const Gravity attraction_of_outer_planets{.G = outer_G};

template <class... Fs> Classical<double> encke_over(Fs... forces) {
  return classical_over(field_of(std::move(forces)...), method("encke_gauss_8"));
}
template <class... Fs> Simulation<double> encke_run(ParticleSystem<double> s, double h, Fs... forces) {
  return {std::move(s), encke_over(std::move(forces)...), h};
}

}  // namespace

TEST_CASE("departures from orbits are right to 1e-17 of positions after 20 years of the outer planets", "[encke]") {
  const double h = 182.625;
  auto run = encke_run(outer_planets(), h, attraction_of_outer_planets);
  REQUIRE(run.run(40).ok());
  CHECK(worst_error(run.particles(), truth_of(outer_planets(), h, 40, 1, attraction_of_outer_planets)) < 1e-17);
}

TEST_CASE("the energy of the outer planets is kept to some 1e-18 over 1e4 years, and the monitor sees it", "[encke]") {
  // Errors walk at random: of 12 starts some roundings apart the median of the largest error was 3e-18, the worst, that
  // of the first one, 1.01e-17; of 16 others the worst was 6.3e-18.
  std::vector<double> worst;
  for (int k = 0; k < 9; ++k) {
    ParticleSystem<double> start = outer_planets();
    for (Index i = 0; i < start.size(); ++i)
      start.positions().set(i, (1 + 3e-16 * k * (1 + 0.37 * static_cast<double>(i))) * start.positions()[i]);
    auto run = encke_run(start, 300, attraction_of_outer_planets);
    const Energy& energy = run.every(100, Energy{});
    REQUIRE(run.run(12175).ok());
    worst.push_back(energy.worst());
  }
  std::sort(worst.begin(), worst.end());
  CAPTURE(worst);
  CHECK(worst[4] < 6e-18);
  CHECK(worst[8] < 1.5e-17);
  CHECK(worst[0] > 1e-24);  // not rounded away
}

TEST_CASE("the energy monitor tells what 113 bits tell of both words", "[encke][energy]") {
  ParticleSystem<double> start = outer_planets();
  auto run = encke_run(start, 800, attraction_of_outer_planets);  // long enough to lose something
  const Energy& energy = run.every(20, Energy{});
  REQUIRE(run.run(20).ok());
  start.keep_low_words(true);
  const Quad before = energy_of(start, outer_G), after = energy_of(run.particles(), outer_G);
  const double right = std::abs(static_cast<double>((after - before) / before));
  CAPTURE(energy.worst(), right);
  CHECK(right > 0);
  CHECK(std::abs(energy.worst() - right) < 1e-9 * right + 1e-30);
}

TEST_CASE("two bodies move as Kepler has it, at any eccentricity", "[encke]") {
  for (const double e : {0.0, 0.5, 0.99}) {
    const ParticleSystem<double> start = kepler_pair(e, 0.3);
    auto run = encke_run(start, 0.375, Gravity{.G = 1});
    REQUIRE(run.run(100).ok());
    const Words one = words_of(run.particles(), 0), other = words_of(run.particles(), 1);
    const Vec3<Quad> right = kepler_motion<Quad>(start.as<Quad>(), Quad(37.5)).x, off = (other.x - one.x) - right;
    CAPTURE(e);
    CHECK(static_cast<double>(sqrt(norm2(off))) < 1e-24);
  }
}

TEST_CASE("tracers and an oblate primary under the method, against 113 bits", "[encke]") {
  ParticleSystem<double> start = outer_planets();
  start.add("tracer", 0, {2.5, 0.3, 0.2}, {-0.001, 0.0105, 0.001});
  const Oblateness flat{.J2 = 1e-4, .radius = 0.1, .axis = {0.2, 0, 1}, .G = outer_G};
  const double h = 60;
  auto run = encke_run(start, h, attraction_of_outer_planets, flat);
  REQUIRE(run.run(60).ok());
  const double error = worst_error(run.particles(), truth_of(start, h, 60, 1, attraction_of_outer_planets, flat));
  CAPTURE(error);
  CHECK(error < 1e-17);
  auto without = encke_run(start, h, attraction_of_outer_planets);
  REQUIRE(without.run(60).ok());
  CHECK((without.particles().positions()[1] - run.particles().positions()[1]).norm() > 1e-9);
}

TEST_CASE("the centre of mass goes on evenly to the last bit of both words", "[encke]") {
  ParticleSystem<double> start = outer_planets();
  for (Index i = 0; i < start.size(); ++i) {
    start.velocities().set(i, start.velocities()[i] + Vec3<double>(0.01, -0.002, 0.003));
  }
  const auto momentum = [](const ParticleSystem<double>& s) {
    Vec3<Quad> sum = Vec3<Quad>::Zero();
    for (Index i = 0; i < s.size(); ++i) sum += Quad(s.masses()[i]) * words_of(s, i).v;
    return sum;
  };
  auto run = encke_run(start, 300, attraction_of_outer_planets);
  start.keep_low_words(true);
  const Vec3<Quad> before = momentum(start);
  REQUIRE(run.run(500).ok());
  CHECK(static_cast<double>(sqrt(norm2(Vec3<Quad>(momentum(run.particles()) - before)) / norm2(before))) < 1e-29);
}

TEST_CASE("the heaviest body is the primary, wherever it stands", "[encke]") {
  const ParticleSystem<double> first = outer_planets();
  ParticleSystem<double> last(first.units());
  for (Index i = first.size(); i-- > 0;)
    last.add(first.name(i), first.masses()[i], first.positions()[i], first.velocities()[i]);
  auto one = encke_run(first, 300, attraction_of_outer_planets),
       other = encke_run(last, 300, attraction_of_outer_planets);
  REQUIRE(one.run(100).ok());
  REQUIRE(other.run(100).ok());
  for (Index i = 0; i < first.size(); ++i) {
    const Vec3<Quad> off = words_of(one.particles(), i).x - words_of(other.particles(), first.size() - 1 - i).x;
    CHECK(static_cast<double>(sqrt(norm2(off))) < 1e-15);
  }
}

TEST_CASE("what the method cannot serve is refused by name, and departures that do not settle end the run", "[encke]") {
  const auto start = [](ParticleSystem<double> s, Classical<double> integrator) {
    Simulation<double> run(std::move(s), std::move(integrator), 1.0);
  };
  CHECK_THROWS_WITH(start(outer_planets(), encke_over(HarmonicField{1})),
                    "method 'encke_gauss_8' is for masses without softening that attract each other, but "
                    "'kinetic_potential' has no such gravity; use 'gauss_8'");
  CHECK_THROWS_WITH(start(outer_planets(), encke_over(Gravity{.softening = 0.1})),
                    Catch::Contains("masses without softening"));
  CHECK_THROWS_WITH(start(outer_planets(), encke_over(Gravity{}, DragForce{{.rate = 1e-9}})),
                    Catch::Contains("a force depends on velocities"));
  ParticleSystem<double> light;
  light.add("a", 0, {1, 0, 0}, {0, 0, 0});
  light.add("b", 0, {2, 0, 0}, {0, 0, 0});
  CHECK_THROWS_WITH(start(light, encke_over(Gravity{})), Catch::Contains("no body has a mass"));
  CHECK_THROWS_WITH(make_method<Quad>(*methods::find("encke_gauss_8"), {}),
                    "method 'encke_gauss_8' computes in double only, not in extended precision");

  ParticleSystem<double> stars;  // none of them dominates
  stars.add("a", 1, {1, 0, 0}, {0, 0.6, 0});
  stars.add("b", 1, {-1, 0.1, 0}, {0.1, -0.5, 0});
  CHECK_NOTHROW(start(stars, encke_over(Gravity{.G = 1})));  // two bodies move on their orbit exactly
  stars.add("c", 0, {0, 1.5, 0.3}, {-0.5, 0, 0.1});
  CHECK_THROWS_WITH(start(stars, encke_over(Gravity{.G = 1})),
                    "method 'encke_gauss_8' follows orbits about one body that dominates, but particle 1 has 1 of the "
                    "mass of the heaviest one, particle 0; use 'wide_gauss_8'");
}

TEST_CASE("steps with bodies too near to each other for errors below 1e-18 are counted", "[encke]") {
  ParticleSystem<double> s;
  s.add("star", 1, {0, 0, 0}, {0, 0, 0});
  s.add("moonlet", 1e-17, {1, 0, 0}, {0, 1, 0});
  s.add("other moonlet", 1e-17, {1, 0, 1.5e-6}, {0, 1, 0});
  auto near = encke_run(s, 0.05, Gravity{.G = 1});
  REQUIRE(near.run(3).ok());
  CHECK(near.evaluations().unsettled == 3);
  auto again = encke_run(s, 0.05, Gravity{.G = 1});
  again.restore(near.save());
  REQUIRE(again.run(1).ok());
  CHECK(again.evaluations().unsettled == 4);
  auto planets = encke_run(outer_planets(), 300, attraction_of_outer_planets);
  REQUIRE(planets.run(50).ok());
  CHECK(planets.evaluations().unsettled == 0);
}

TEST_CASE("an encounter that steps jump over ends the run by name", "[encke]") {
  // Two planets on one circle, against each other: they pass at a thousandth of its radius.
  ParticleSystem<double> s;
  s.add("star", 1, {0, 0, 0}, {0, 0, 0});
  s.add("planet", 1e-3, {1, 0, 0}, {0, 1, 0});
  s.add("retrograde planet", 1e-3, {-1, 0, 0.001}, {0, 1, 0});
  auto run = encke_run(s, 0.5, Gravity{.G = 1});
  const Outcome outcome = run.run(20);
  CAPTURE(outcome.message);
  CHECK(outcome.kind == Outcome::Kind::solver_failure);
  CHECK(outcome.message.find("with a step of 0.5; give a shorter one, or use 'wide_gauss_8', or 'gauss_8', which "
                             "chooses its steps") != std::string::npos);
}

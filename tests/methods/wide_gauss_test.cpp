/// Gauss's collocation on states of double-doubles: errors below the rounding of doubles, without a heavy body.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "integrators/classical.hpp"
#include "monitors/monitors.hpp"
#include "tests/methods/both_words.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/problems.hpp"

#include <cmath>
#include <string>

using namespace noether;
using namespace noether::test;

namespace {

template <class... Fs> Simulation<double> wide_run(ParticleSystem<double> s, double h, Fs... forces) {
  return {std::move(s), classical_over(field_of(std::move(forces)...), method("wide_gauss_8")), h};
}

/// Two equal stars of e = 0.4 with a planet and a tracer around both.
ParticleSystem<double> stars() {
  ParticleSystem<double> s;
  const double v = std::sqrt(0.6 / 1.4) / 2;  // at the apocenter of a = 1
  s.add("star", 0.5, {0.7, 0, 0}, {0, v, 0});
  s.add("other star", 0.5, {-0.7, 0, 0}, {0, -v, 0});
  s.add("planet", 1e-3, {5, 0.3, 0.2}, {-0.02, 0.44, 0.03});
  s.add("tracer", 0, {-7, 1, 0.5}, {0.05, -0.38, 0.01});
  return s;
}

}  // namespace

TEST_CASE("stars, a planet and a tracer are right to 1e-18 of positions", "[wide_gauss]") {
  auto run = wide_run(stars(), 0.125, Gravity{.G = 1});
  REQUIRE(run.run(80).ok());
  CHECK(worst_error(run.particles(), truth_of(stars(), 0.125, 80, 2, Gravity{.G = 1})) < 1e-18);
}

TEST_CASE("forces beside gravity join the stages of double-doubles", "[wide_gauss]") {
  const HarmonicField weak{1e-8};
  auto run = wide_run(stars(), 0.125, Gravity{.G = 1}, weak);
  REQUIRE(run.run(80).ok());
  CHECK(worst_error(run.particles(), truth_of(stars(), 0.125, 80, 2, Gravity{.G = 1}, weak)) < 1e-18);
  auto without = wide_run(stars(), 0.125, Gravity{.G = 1});
  REQUIRE(without.run(80).ok());
  CHECK((without.particles().positions()[3] - run.particles().positions()[3]).norm() > 1e-8);
}

TEST_CASE("the energy of two equal stars is kept to 1e-18 over 160 periods, the momenta too, and monitors see it",
          "[wide_gauss]") {
  ParticleSystem<double> start = stars();
  auto run = wide_run(start, 0.125, Gravity{.G = 1});
  const Energy& energy = run.every(100, Energy{});
  const Momentum& momentum = run.every(100, Momentum{});
  const AngularMomentum& turning = run.every(100, AngularMomentum{});
  REQUIRE(run.run(8000).ok());
  CHECK(momentum.worst() < 1e-25);
  CHECK(turning.worst() < 1e-18);
  CHECK(turning.worst() > 0);
  CHECK(energy.worst() < 1e-18);
  CHECK(energy.worst() > 1e-26);
}

TEST_CASE("both methods of double-doubles agree on the outer planets far below the rounding of doubles",
          "[wide_gauss][encke]") {
  const Gravity gravity{.G = outer_G};
  auto wide = wide_run(outer_planets(), 120, gravity);
  Simulation<double> encke(outer_planets(), classical_over(field_of(gravity), method("encke_gauss_8")), 120.0);
  REQUIRE(wide.run(100).ok());
  REQUIRE(encke.run(100).ok());
  for (Index i = 0; i < wide.particles().size(); ++i) {
    const Vec3<Quad> off = words_of(wide.particles(), i).x - words_of(encke.particles(), i).x;
    CHECK(static_cast<double>(sqrt(norm2(off))) < 1e-16);
  }
}

TEST_CASE("a restart and looks in between leave the bits of both words", "[wide_gauss][encke][restart]") {
  for (const char* name : {"wide_gauss_8", "encke_gauss_8"}) {
    CAPTURE(name);
    const auto planets = [&] {
      return Simulation<double>(outer_planets(), classical_over(field_of(Gravity{.G = outer_G}), method(name)), 200.0);
    };
    auto whole = planets(), first = planets(), second = planets();
    first.every(3, Energy{});
    second.every(3, Energy{});
    REQUIRE(whole.run(40).ok());
    REQUIRE(first.run(17).ok());
    second.restore(first.save());
    REQUIRE(second.run(23).ok());
    for (Index i = 0; i < whole.particles().size(); ++i) {
      const Words one = words_of(whole.particles(), i), other = words_of(second.particles(), i);
      CHECK((one.x == other.x && one.v == other.v));
    }
    CHECK(whole.evaluations().kepler == second.evaluations().kepler);
    CHECK((whole.evaluations().kepler > 0) == (name == std::string("encke_gauss_8")));
  }
}

TEST_CASE("stages that do not settle end the run", "[wide_gauss]") {
  auto run = wide_run(stars(), 20, Gravity{.G = 1});
  const Outcome outcome = run.run(10);
  CHECK(outcome.kind == Outcome::Kind::solver_failure);
  CHECK(outcome.message == "the stages of 'wide_gauss_8' do not converge with a step of 20; give a shorter one");
}

/// Angles of resonances: orbits whose angle is known, and the plutino.

#include "engine/simulation.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/wisdom_holman.hpp"
#include "monitors/resonance_angle.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/refusal.hpp"

#include <cmath>
#include <numbers>

using namespace noether;
using namespace noether::test;

namespace {

constexpr double degree = std::numbers::pi / 180;

/// A star and two tracers, the outer one with `ratio` times the period of the inner one.
ParticleSystem<double> pair_of_tracers(double ratio) {
  ParticleSystem<double> s;
  s.add("star", 1, {0, 0, 0}, {0, 0, 0});
  const auto put = [&](const char* name, double a, double e, double omega, double M) {
    const auto [x, v] = state_from_elements<double>({a, e, 0, 0, omega, M}, 1.0);
    s.add(name, 0, x, v);
  };
  put("inner", 1, 0, 0, 20 * degree);
  put("outer", std::cbrt(ratio * ratio), 0.2, 50 * degree, 10 * degree);
  return s;
}

}  // namespace

TEST_CASE("the angle of orbits in an exact resonance stays, and of others it circulates", "[resonance]") {
  for (const double ratio : {1.5, 1.52}) {
    const ParticleSystem<double> start = pair_of_tracers(ratio);
    Simulation<double> sim(start, compose(WisdomHolman<double>({.G = 1.0}), schemes::verlet_aba), 0.2);
    auto& angle = sim.every(2, ResonanceAngle("inner", "outer", 2, 1));
    REQUIRE(sim.run(3000).ok());
    // 3 lambda_outer - 2 lambda_inner - varpi_outer = 3 * 60 - 2 * 20 - 50 = 90 degrees.
    if (ratio == 1.5) {
      CHECK(std::abs(angle.center() - 90 * degree) < 1e-8);
      CHECK(angle.amplitude() < 1e-8);
      CHECK(angle.librates());
      CHECK(angle.report().verdict == "librates about 90.0 deg by 0.0 deg");
    } else {
      // 3 n_outer - 2 n_inner = 3/1.52 - 2 in units of n_inner, over a time of 600.
      CHECK_FALSE(angle.librates());
      CHECK(std::abs(angle.amplitude() - std::abs(3 / 1.52 - 2) * 600 / 2) < 1e-6);
    }
  }
}

TEST_CASE("Pluto librates about 180 degrees in its 3 : 2 resonance with Neptune", "[resonance]") {
  // Murray and Dermott (1999), 9.5: about 180 degrees with an amplitude near 82 and a period of 19 700 years.
  Simulation<double> sim(outer_planets(), compose(WisdomHolman<double>({.G = outer_G}), schemes::verlet_aba), 200);
  auto& angle = sim.every(50, ResonanceAngle("Neptune", "Pluto", 2, 1));
  REQUIRE(sim.run(40000).ok());
  CHECK(angle.librates());
  CHECK(std::abs(std::remainder(angle.center() - std::numbers::pi, 2 * std::numbers::pi)) < 8 * degree);
  CHECK(angle.amplitude() > 72 * degree);
  CHECK(angle.amplitude() < 95 * degree);
}

TEST_CASE("what is not a resonance of two bodies is refused", "[resonance]") {
  const ParticleSystem<double> s = pair_of_tracers(1.5);
  const auto refusal = [&](const ResonanceAngle& angle) { return refusal_of([&] { angle.check(s); }); };
  CHECK(refusal({"inner", "ouder", 2, 1}).find("\"ouder\" in bodies is not a particle") != std::string::npos);
  CHECK(refusal({"inner", "inner", 2, 1}).find("not a pair of bodies") != std::string::npos);
  CHECK(refusal({"inner", "outer", 0, 1}).find("p = 0 is out of range") != std::string::npos);
  CHECK(refusal({"star", "outer", 2, 1}).find("'star' is one of the two bodies") != std::string::npos);
  ResonanceAngle far("inner", "outer", 2, 1);
  far.pericenter = "star";
  CHECK(refusal(far).find("not one of the two bodies") != std::string::npos);
}

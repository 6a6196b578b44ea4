/// The secular frequencies of the outer Solar System against those of the literature.

#include "engine/simulation.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/wisdom_holman.hpp"
#include "monitors/orbital_monitors.hpp"
#include "study/frequencies.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/planets.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

using namespace noether;
using namespace noether::test;

TEST_CASE("the outer Solar System has the secular frequencies g5, g6 and s6", "[frequencies][slow]") {
  constexpr double step = 200, arcsecond_per_year = std::numbers::pi / (180 * 3600) / 365.25;
  constexpr std::int64_t between = 1000;
  Simulation<double> sim(outer_planets(), compose(WisdomHolman<double>({.G = outer_G}), schemes::verlet_aba), step);
  auto& elements = sim.every(between, Elements(outer_G));
  std::vector<std::complex<double>> jupiter, saturn, node;
  for (int k = 0; k < 5000; ++k) {
    REQUIRE(sim.run(between).ok());
    const OrbitalElements<double> j = elements.of(1), s = elements.of(2);
    jupiter.push_back(std::polar(j.e, j.Omega + j.omega));
    saturn.push_back(std::polar(s.e, s.Omega + s.omega));
    node.push_back(std::polar(std::sin(s.inc / 2), s.Omega));
  }
  const auto error = [&](const std::vector<std::complex<double>>& signal, double literature) {
    double least = INFINITY;
    for (const FrequencyTerm& one : frequency_terms(signal, 0, step * between, {.terms = 3}))
      least = std::min(least, std::abs(one.frequency / arcsecond_per_year - literature));
    return least;
  };
  // Laskar and others (2004): 4.257, 28.245 and -26.348 arc seconds a year, with the inner planets, which are not here.
  CHECK(error(jupiter, 4.257) < 0.03);
  CHECK(error(saturn, 28.245) < 0.15);
  CHECK(error(node, -26.348) < 0.1);
}

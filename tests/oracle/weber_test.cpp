// Weber's electrodynamics: orbits of extended precision, what many charges keep, and where like charges have no motion.

#include "integrators/systems/weber.hpp"

#include "integrators/all_methods.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

using namespace noether;

namespace {

/// Two charges on a line that fly at each other, a reduced mass of 1.
Weber head_on(double c) {
  return {.masses = {2, 2},
          .charges = {1, 1},
          .positions = {2.5, 0, 0, -2.5, 0, 0},
          .velocities = {-0.5, 0, 0, 0.5, 0, 0},
          .c = c};
}

/// So many charges of both signs in a box, none near another.
Weber cloud(int n) {
  Weber all{.masses = {}, .charges = {}, .positions = {}, .velocities = {}, .k = 0.1, .c = 3};
  for (int i = 0; i < n; ++i) {
    all.masses.push_back(1 + 0.1 * (i % 4));
    all.charges.push_back(i % 2 == 0 ? 1 : -1);
    for (const int cell : {i % 3, i / 3 % 3, i / 9})
      all.positions.push_back(1.5 * cell + 0.2 * std::sin(7.0 * i + cell));
    for (int d = 0; d < 3; ++d) all.velocities.push_back(0.3 * std::cos(3.0 * i + d));
  }
  return all;
}

std::array<double, 6> momenta(const std::vector<double>& y) {
  std::array<double, 6> sums{};
  const std::size_t half = y.size() / 2;
  for (std::size_t i = 0; i < half; i += 3) {
    for (std::size_t d = 0; d < 3; ++d) {
      const std::size_t a = (d + 1) % 3, b = (d + 2) % 3;
      sums[d] += y[half + i + d];
      sums[3 + d] += y[i + a] * y[half + i + b] - y[i + b] * y[half + i + a];
    }
  }
  return sums;
}

}  // namespace

TEST_CASE("a pair under Weber's force is where extended precision has it", "[weber]") {
  for (const char* name : {"galerkin_gauss_3", "gauss_4"}) {
    CAPTURE(name);
    MethodChoice choice = method(name);
    if (std::string(name) == "gauss_4") choice.options.adaptive = false;
    Simulation run(initial_state(Weber{}), classical(Weber{}, choice), 0.02);
    REQUIRE(run.run(1000).ok());
    const auto& y = run.particles().variables();
    CHECK(std::abs(y[0] - y[3] - 0.75529965197821358317) < 2e-9);
    CHECK(std::abs(y[1] - y[4] - 0.62456010047866138655) < 2e-9);
    CHECK(std::abs(y[2] - y[5]) == 0);
  }
}

TEST_CASE("Weber's force keeps energy, momentum and angular momentum of 2, 3 and 20 charges", "[weber]") {
  for (const int n : {2, 3, 20}) {
    CAPTURE(n);
    const Weber system = cloud(n);
    Simulation run(initial_state(system), classical(system, method("galerkin_gauss_2")), 0.02);
    Energy& energy = run.every(1, Energy());
    const std::array<double, 6> before = momenta(run.particles().variables());
    REQUIRE(run.run(n == 20 ? 5 : 500).ok());
    const std::array<double, 6> after = momenta(run.particles().variables());
    for (std::size_t k = 0; k < 6; ++k) CHECK(std::abs(after[k] - before[k]) < 1e-13 * n);
    CHECK(energy.worst() < 1e-7);
  }
}

TEST_CASE("like charges turn at k/E, or end by name where their mass vanishes first", "[weber][extremes]") {
  for (const char* name : {"galerkin_gauss_2", "gauss_2"}) {
    CAPTURE(name);
    MethodChoice choice = method(name);
    if (std::string(name) == "gauss_2") choice.options.adaptive = false;
    const Weber turns = head_on(2);
    Simulation run(initial_state(turns), classical(turns, choice), 0.01);
    double nearest = 5;
    for (int k = 0; k < 1000; ++k) {
      REQUIRE(run.run(1).ok());
      nearest = std::min(nearest, run.particles().variables()[0] - run.particles().variables()[3]);
    }
    CHECK(std::abs(nearest - 1.48148148148148148148) < 1e-4);  // looked at every 0.01
    const Weber ends = head_on(0.5);                           // r_c = 4, but k/E = 3.33
    Simulation fall(initial_state(ends), classical(ends, choice), 0.01);
    const Outcome outcome = fall.run(100000);
    CHECK(outcome.kind == Outcome::Kind::solver_failure);
    CAPTURE(outcome.message);
    const double apart = fall.particles().variables()[0] - fall.particles().variables()[3];
    CHECK(apart > 4);
    CHECK(apart < 4.5);
  }
}

TEST_CASE("charges that are no system of Weber's are refused", "[weber]") {
  const auto refusal = [](const Weber& system) {
    try {
      system.check();
    } catch (const Error& error) {
      return error.message();
    }
    return std::string("nothing");
  };
  CHECK(refusal({}) == "nothing");
  CHECK_THAT(refusal({.charges = {1}}), Catch::Contains("charges = a list of 1 does not fit 2 masses"));
  CHECK_THAT(refusal({.masses = {1}}), Catch::Contains("two charges or more are expected"));
  CHECK_THAT(refusal({.masses = {1, 0}}), Catch::Contains("is not a valid mass"));
  CHECK_THAT(refusal({.c = 0}), Catch::Contains("c = 0 is not a valid speed of light"));
  CHECK_THAT(refusal({.positions = {1, 2, 3, 1, 2, 3}}),
             Catch::Contains("(1, 2, 3) puts charges 1 and 2 at one place"));
}

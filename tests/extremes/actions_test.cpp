/// Actions at their ends: masses that vanish, momenta near the largest numbers, steps far beyond the motion.

#include "integrators/systems/double_pendulum.hpp"
#include "integrators/systems/pendulum.hpp"
#include "integrators/systems/polar_kepler.hpp"
#include "integrators/variational/lagrangian_system.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <string>

namespace noether::test {
namespace {

constexpr const char* paths[] = {"variational_midpoint", "variational_trapezoidal", "galerkin_gauss_3",
                                 "galerkin_lobatto_4"};

template <class S>
Simulation<double> run_of_action(const S& system, std::vector<double> y, const char* name, double h) {
  return {initial_state(system, std::move(y)), variational(system, method(name)), h};
}

/// A run that ends early has a name for it, and a finite state.
void check_end(Simulation<double>& run, const Outcome& outcome) {
  CAPTURE(to_text(outcome));
  CHECK((outcome.ok() || !outcome.message.empty()));
  CHECK(outcome.step == run.step());
  for (const double y : run.particles().variables()) CHECK(std::isfinite(y));
}

TEST_CASE("orbits that fall into the centre of polar coordinates end by name, whatever the step", "[actions]") {
  for (const char* name : paths) {
    for (const double momentum : {0.0, 1e-3}) {
      for (const double h : {0.05, 100.0}) {
        CAPTURE(name, momentum, h);
        auto run = run_of_action(PolarKepler{}, {1.0, 0.0, 0.0, momentum}, name, h);
        check_end(run, run.run(30));
      }
    }
  }
}

TEST_CASE("pendulums of any scale swing as the one of scale 1, and steps beyond a swing end by name or go on",
          "[actions]") {
  for (const char* name : paths) {
    CAPTURE(name);
    const auto end = [&](double scale) {
      const SimplePendulum system{.mass = scale, .length = 1, .g = 1};
      auto run = run_of_action(system, {2.0, 0.3 * scale}, name, 0.25);
      const Outcome outcome = run.run(20);
      check_end(run, outcome);
      CHECK(outcome.ok());
      return run.particles().variables();
    };
    const auto plain = end(1);
    for (const int power : {-300, 300}) {
      const double scale = std::ldexp(1, power);
      const auto scaled = end(scale);
      CHECK(std::abs(scaled[0] - plain[0]) < 1e-12);
      CHECK(std::abs(scaled[1] / scale - plain[1]) < 1e-12);
    }
    for (const double h : {3.0, 1e6}) {
      auto run = run_of_action(DoublePendulum{}, {1.0, 2.0, 0.0, 0.0}, name, h);
      check_end(run, run.run(4));
    }
  }
}

}  // namespace
}  // namespace noether::test

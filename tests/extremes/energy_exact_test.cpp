/// Methods exact in energy where steps see nothing of what is fast: the root that continues the step, or a named end.

#include "forces/springs.hpp"
#include "tests/extremes/support.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/problems.hpp"

#include <algorithm>
#include <cmath>

namespace noether::test {

namespace {

constexpr double turn = 6.28318530717958647693;

/// A body on a tether of length 1 whose oscillations have h omega = z at a step of 0.05.
WatchedRun on_tether(std::string_view name, double z) {
  const double omega = z / 0.05;
  return {particle_in_plane(1, 0, 0, 1),
          classical_over(Tether{.k = omega * omega, .length = 1, .tied = {{0}}}, method(name)), 0.05};
}

/// An ellipse of a = 1 from its apocenter, two bodies of masses 3/4 and 1/4.
WatchedRun on_ellipse(std::string_view name, double e, std::int64_t steps_a_period) {
  return {kepler_pair(e, turn / 2), classical_over(Gravity{}, method(name)),
          turn / static_cast<double>(steps_a_period)};
}

/// What holds at the end of every run, whatever happened.
void check_end(WatchedRun& run, const Outcome& outcome) {
  CHECK(outcome.step == run.simulation.step());
  CHECK(is_finite(run.simulation.particles()));
  CHECK(outcome.message.empty() == (outcome.kind == Outcome::Kind::completed));
}

}  // namespace

TEST_CASE("a tether turns on at any stiffness by secants, with energy and angular momentum to rounding",
          "[extremes][energy]") {
  for (const double z : {0.5, 10.0, 50.0, 1e3, 1e4}) {
    CAPTURE(z);
    WatchedRun run = on_tether("simo_tarnow_wong", z);
    const Outcome outcome = run.simulation.run(1000);
    CAPTURE(outcome.message);
    check_end(run, outcome);
    CHECK(outcome.kind == Outcome::Kind::completed);
    CHECK(run.energy.worst() < 1e-12);
    const Vec3<double> x = run.simulation.particles().positions()[0], v = run.simulation.particles().velocities()[0];
    CHECK(std::abs(x[0] * v[1] - x[1] * v[0] - 1) < 1e-13);
    // By the force of its turning it is longer by v^2 / k, and it oscillates by no more.
    CHECK(std::abs(std::sqrt(norm2(x)) - 1) < 2.5 * std::min(1.0, 0.0025 / (z * z)) + 1e-15);
  }
}

TEST_CASE("where no root continues the step at h omega = 1e4 no other one is taken, and the run says so",
          "[extremes][energy]") {
  for (const char* name : {"gonzalez", "itoh_abe_symmetric"}) {
    CAPTURE(name);
    WatchedRun run = on_tether(name, 1e4);
    const Outcome outcome = run.simulation.run(1000);
    check_end(run, outcome);
    CHECK(outcome.kind == Outcome::Kind::solver_failure);
    CHECK_THAT(outcome.message, Catch::Contains("have no solution that continues the motion beyond"));
    CHECK(run.energy.worst() < 1e-9);  // no other root of the energy was taken before
  }
}

TEST_CASE("line integrals turn a tether on while their root is found, and beyond the run says so",
          "[extremes][energy]") {
  for (const char* name : {"avf", "avf_4", "hbvm_2", "hbvm_3"}) {
    CAPTURE(name);
    for (const double z : {0.5, 10.0, 50.0}) {
      CAPTURE(z);
      WatchedRun run = on_tether(name, z);
      const Outcome outcome = run.simulation.run(500);
      CAPTURE(outcome.message);
      check_end(run, outcome);
      CHECK(outcome.kind == Outcome::Kind::completed);
      CHECK(run.energy.worst() < 1e-9);
      // At another root of the energy the length would be off by up to 0.05 / z. (The correction of avf_4 lets stiff
      // oscillations swell.)
      const double swells = std::string_view(name) == "avf_4" ? 25 : 2.5;
      const Vec3<double> x = run.simulation.particles().positions()[0];
      CHECK(std::abs(std::sqrt(norm2(x)) - 1) < swells * std::min(1.0, 0.0025 / (z * z)));
    }
    WatchedRun run = on_tether(name, 1e4);
    const Outcome outcome = run.simulation.run(1000);
    check_end(run, outcome);
    CHECK(outcome.kind == Outcome::Kind::solver_failure);
    CHECK_THAT(outcome.message, Catch::Contains("with a step of 0.05; give a shorter one"));
    CHECK(run.energy.worst() < 1e-9);
  }
}

TEST_CASE("line integrals pass the pericenter of a needle by short steps of high order, and else end there by name",
          "[extremes][energy]") {
  for (const char* name : {"avf", "avf_4", "hbvm_2", "hbvm_3", "hbvm_4"}) {
    CAPTURE(name);
    for (const std::int64_t steps : {200, 2000}) {
      WatchedRun run = on_ellipse(name, 0.999, steps);
      const Outcome outcome = run.simulation.run(2 * steps);
      check_end(run, outcome);
      CHECK(outcome.kind == Outcome::Kind::solver_failure);
      CHECK(std::abs(outcome.time - turn / 2) < 2 * turn / static_cast<double>(steps));
      // A pericenter between two nodes is not always seen (docs/theory/energy_exact.md): 5.7e-7 of hbvm_2 in its last
      // step, 1e-10 of hbvm_3.
      CHECK(run.energy.worst() < (std::string_view(name) == "hbvm_2" ? 1e-6 : 1e-9));
    }
  }
  WatchedRun close = on_ellipse("hbvm_4", 0.99, 10000);
  REQUIRE(close.simulation.run(6000).ok());
  CHECK(close.energy.worst() < 1e-11);
}

TEST_CASE("a needle of an ellipse is passed by short steps, and by long ones not; no step jumps to another root",
          "[extremes][energy]") {
  for (const char* name : {"simo_tarnow_wong", "gonzalez"}) {
    CAPTURE(name);
    WatchedRun close = on_ellipse(name, 0.99, 10000);
    REQUIRE(close.simulation.run(11000).ok());
    CHECK(close.energy.worst() < 1e-11);
    for (const std::int64_t steps : {200, 2000}) {
      WatchedRun run = on_ellipse(name, 0.999, steps);
      const Outcome outcome = run.simulation.run(2 * steps);
      check_end(run, outcome);
      CHECK(outcome.kind == Outcome::Kind::solver_failure);
      CHECK(std::abs(outcome.time - turn / 2) < 2 * turn / static_cast<double>(steps));
      CHECK(run.energy.worst() < 1e-11);
    }
  }
}

}  // namespace noether::test

// Studies of scenes whose clock does not begin at 0: forces of time act at the times of the clock.

#include "study/advise.hpp"
#include "study/compare.hpp"
#include "study/find_truth.hpp"
#include "study/measure.hpp"
#include "study/spectrum.hpp"
#include "tests/study/scenes.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <cmath>

namespace noether::test {
namespace {

/// A bob that an oscillating field drives, x'' = 0.7 cos(1.25 t + 0.5), from rest at 0.25.
Scene driven_bob(double start, const std::string& integrator) {
  return read_scene(fmt::format(R"(units = "reduced"
[particles]
body = [{{ name = "bob", mass = 1, x = [0.25, 0, 0], v = [0, 0, 0] }}]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "oscillating_field"
acceleration = [0.7, 0, 0]
omega = 1.25
phase = 0.5
[integrator]
start_time = {}
{}
)",
                                start, integrator),
                    "driven.toml");
}

/// Its place so long after the start, in closed form.
double place_of_bob(double start, double later) {
  const double w = 1.25, g = 0.7, a = w * start + 0.5, b = w * (start + later) + 0.5;
  return 0.25 - g / w * std::sin(a) * later - g / (w * w) * (std::cos(b) - std::cos(a));
}

}  // namespace

TEST_CASE("the truth of a driven scene is that of its own clock", "[truth][start time]") {
  for (const double start : {0.0, 1000.0, -3.5}) {
    const Scene scene = driven_bob(start, fmt::format("method = \"verlet\"\nstep = 0.01\nuntil = {}", start + 20));
    const Sampling sampling = sampling_of(scene, {});
    CHECK(sampling.start == start);
    CHECK(std::abs(sampling.end() - 20) < 1e-9);
    const Truth truth = find_truth(scene, sampling);
    REQUIRE(truth.kind == TruthKind::quad);
    double worst = 0;
    for (int j = 0; j <= 200; ++j) {
      const double found = static_cast<double>(truth.y[static_cast<std::size_t>(j)][0]);
      worst = std::max(worst, std::abs(found - place_of_bob(start, sampling.time(j))));
    }
    CAPTURE(start, worst);
    CHECK(worst < 1e-11);
  }
}

TEST_CASE("methods are compared with it at moments of the clock, fixed steps and free ones", "[compare][start time]") {
  const Scene scene = driven_bob(1000, "method = \"verlet\"\nstep = 0.01\nuntil = 1020");
  CompareOptions options;
  options.methods = {"verlet", "rk4", "dop853"};
  options.steps = {0.01};
  options.tolerances = {1e-10};
  options.repeats = 1;
  const Comparison found = compare(scene, options);
  REQUIRE(found.rows.size() == 3);
  for (const Row& row : found.rows) {
    CAPTURE(row.who.label);
    CHECK(row.completed());
    CHECK(std::abs(row.outcome_time - 1020) < 1e-9);
    REQUIRE(row.position_error_max);
    CHECK(*row.position_error_max < (row.who.method == "verlet" ? 1e-4 : 1e-8));
    CHECK(*row.position_error_max > 0);
  }
  CHECK_THROWS_WITH(sampling_of(scene, 1000.0), Catch::Contains("this one would end at 1000, from a start at 1000"));
  CHECK(std::abs(sampling_of(scene, 1010.0).end() - 10) < 1e-12);
}

TEST_CASE("what nothing drives has the same rows wherever its clock begins", "[compare][start time]") {
  const auto rows = [](double start) {
    const Scene scene =
        kepler(0.5, fmt::format("method = \"yoshida_4\"\nstep = 0.0625\nstart_time = {}\nsteps = 200", start));
    CompareOptions options;
    options.methods = {"yoshida_4", "dop853"};
    options.steps = {0.0625};
    options.tolerances = {1e-8};
    options.repeats = 1;
    return compare(scene, options);
  };
  const Comparison here = rows(0), there = rows(1024);
  REQUIRE(here.rows.size() == 2);
  REQUIRE(there.rows.size() == 2);
  CHECK(here.end == there.end);
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK(here.rows[k].steps == there.rows[k].steps);
    CHECK(here.rows[k].evaluations.force == there.rows[k].evaluations.force);
    CHECK(std::abs(*here.rows[k].position_error_max / *there.rows[k].position_error_max - 1) < 1e-3);
  }
}

TEST_CASE("advice is of the length of a run, and its lines of the clock", "[advise][start time]") {
  const Scene scene = kepler(0.3, "method = \"dop853\"\nstart_time = 512\nuntil = 612");
  AdviseOptions options;
  options.error = 1e-6;
  options.methods = {"dop853"};
  const Advice advice = advise(scene, options);
  CHECK(advice.end == 100);
  CHECK(spectrum_along(scene).fastest > 0);
}

}  // namespace noether::test

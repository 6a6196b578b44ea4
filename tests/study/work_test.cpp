// What a comparison may cost, and what stays of its rows where it must be shorter.

#include "study/compare.hpp"
#include "study/measure.hpp"
#include "study/predictability.hpp"
#include "tests/study/scenes.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace noether::test {
namespace {

/// So many bodies, each on a spring to the origin, x'' = -x: a regular motion that costs little.
Scene springs(int bodies, int steps) {
  std::string body;
  for (int i = 0; i < bodies; ++i) {
    const double x = 1 + 0.01 * i;
    body += fmt::format("{{ mass = 1, x = [{}, {}, 0], v = [0, {}, 0.1] }},\n", x, 0.3 * std::sin(i), 1 / x);
  }
  return read_scene(fmt::format(R"(units = "reduced"
[particles]
body = [
{}]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "harmonic_field"
k = 1
[integrator]
method = "verlet"
step = 0.01
steps = {}
)",
                                body, steps),
                    "springs.toml");
}

TEST_CASE("a comparison that ends earlier has rows of different steps for every method", "[compare][work]") {
  const Scene scene = springs(100, 10000);
  CompareOptions options;
  options.methods = {"verlet", "yoshida_4", "blanes_moan_s6", "srkn14a", "kahan_li_8_s17", "rk4", "dop853"};
  options.repeats = 1;
  options.positions = false;
  const Comparison c = compare(scene, options);
  INFO(c.limits);
  CHECK(c.end < 20);
  CHECK(c.limits.find("so that measuring stays within ") != std::string::npos);
  CHECK(c.sampling.samples >= 4);
  CHECK(c.work.spent <= 1.1 * c.work.most);
  double longest = 0;
  for (const Candidate& who : c.methods) {
    if (who.adaptive) continue;
    std::set<double> steps;
    for (const Row& row : c.rows) {
      if (row.who == who) steps.insert(row.setting.step);
    }
    INFO(who.label);
    CHECK(steps.size() >= 4);
    longest = std::max(longest, *steps.rbegin());
  }
  CHECK(longest > 0.0099);
}

TEST_CASE("steps that were asked for are run however short the comparison is", "[compare][work]") {
  const Scene scene = springs(100, 10000);
  CompareOptions options;
  options.methods = {"verlet", "yoshida_4", "blanes_moan_s6", "kahan_li_8_s17"};
  options.steps = {0.4, 0.1, 0.002, 0.001};
  options.repeats = 1;
  options.positions = false;
  const Comparison c = compare(scene, options);
  INFO(c.limits);
  CHECK(c.end < 100);
  REQUIRE(c.rows.size() == 16);
  for (std::size_t k = 0; k < c.rows.size(); ++k) {
    CHECK(std::abs(c.rows[k].setting.step / options.steps[k % 4] - 1) < 0.25);
  }
}

TEST_CASE("a comparison that cannot be short enough says what it takes", "[compare][work]") {
  const Scene scene = springs(2000, 200);
  CompareOptions options;
  options.methods = {"verlet"};
  options.repeats = 1;
  options.positions = false;
  const Comparison c = compare(scene, options);
  INFO(c.limits);
  CHECK(c.limits.find("runs end after no fewer than 80 steps of the scene, so measuring takes about ") !=
        std::string::npos);
  CHECK(c.limits.find("so that measuring stays within") == std::string::npos);
}

TEST_CASE("no row depends on how often others are timed", "[compare][work]") {
  const Scene scene = springs(100, 10000);
  CompareOptions options;
  options.methods = {"verlet", "rk4", "dop853", "blanes_moan_s6"};
  options.positions = false;
  options.repeats = 1;
  const Comparison once = compare(scene, options);
  options.repeats = 50;
  const Comparison often = compare(scene, options);
  CHECK(often.work.spent <= 1.1 * often.work.most);
  REQUIRE(once.rows.size() == often.rows.size());
  for (std::size_t k = 0; k < once.rows.size(); ++k) {
    const Row &a = once.rows[k], &b = often.rows[k];
    INFO(a.who.label << ", row " << k << ": " << a.message << "; " << b.message);
    CHECK(a.outcome == b.outcome);
    CHECK(a.evaluations.force == b.evaluations.force);
    if (!b.completed()) continue;
    CHECK(b.work > 1.5 * static_cast<double>(b.evaluations.force));  // the run for its time is made in any case
  }
}

TEST_CASE("a run beyond its evaluations says so, and how to compare without a limit", "[compare][work]") {
  const Scene scene = oscillator("method = \"verlet\"\nstep = 0.1\nsteps = 400");
  const Sampling sampling = sampling_of(scene, {});
  const Row row =
      measure(scene, candidate(scene, "verlet"), {.step = 0.1, .tolerance = 0}, sampling, {.most_evaluations = 50});
  CHECK(row.outcome == "over_budget");
  CHECK(row.evaluations.force < 100);
  CHECK(row.message == "it takes more evaluations of forces than measuring may; --until compares without that limit");
}

TEST_CASE("what a step of a method costs is measured once", "[compare][work]") {
  const Scene scene = oscillator("method = \"verlet\"\nstep = 0.1\nsteps = 400");
  StepCosts costs(scene);
  const Candidate who = candidate(scene, "rk4");
  CHECK(costs.of(who, 0.1) == 4);
  CHECK(costs.take_spent() > 0);
  CHECK(costs.of(who, 0.2) == 4);
  CHECK(costs.take_spent() == 0);
}

TEST_CASE("differences are followed to the end where the evaluations just allow it", "[predictability][work]") {
  const Scene scene = kepler(0.2, "method = \"verlet\"\nstep = 0.02\nsteps = 1000");
  double spent = 0;
  const auto whole = predictability(scene, 20, 60, 2010, {}, &spent);  // both runs together take 2000 or 2002
  REQUIRE(whole);
  CHECK(std::abs(whole->times.back() / 20 - 1) < 1e-12);
  CHECK(whole->evaluations <= 2010);
  CHECK(spent == whole->evaluations);
}

}  // namespace
}  // namespace noether::test

// Comparisons and advice where the motion is chaotic, or of many particles.

#include "study/advise.hpp"
#include "study/horizon.hpp"
#include "study/predictability.hpp"
#include "tests/study/scenes.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace noether::test {
namespace {

/// A melt of 4 cells^3 atoms.
Scene melt(int cells, int steps, const std::string& style = "switch_c4") {
  return read_scene(fmt::format(R"(units = "reduced"
[particles]
type = "lattice"
cells = [{0}, {0}, {0}]
density = 0.8442
mass = 1
temperature = 1.44
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "lennard_jones"
cutoff = 1.6
cutoff_style = "{1}"
epsilon = 1
sigma = 1
[integrator]
method = "verlet"
step = 0.005
steps = {2}
)",
                                cells, style, steps),
                    "melt.toml");
}

TEST_CASE("a liquid is chaotic, an orbit is not", "[predictability]") {
  const auto liquid = predictability(melt(2, 2000), 10, 60);
  REQUIRE(liquid);
  CHECK(liquid->chaotic);
  CHECK(liquid->rate > 0.5);  // Lyapunov exponents of Lennard-Jones liquids are of the order of one
  CHECK(liquid->rate < 20);
  CHECK(liquid->factor(2 * liquid->times.back()) > 1e3 * liquid->factor(liquid->times.back()));
  const double at = liquid->time_of(1e5);
  CHECK(std::abs(std::log10(liquid->factor(at)) - 5) < 0.5);
  const auto orbit = predictability(kepler(0.2, "method = \"verlet\"\nstep = 0.02\nsteps = 5000"), 100, 60);
  REQUIRE(orbit);
  CHECK_FALSE(orbit->chaotic);
  CHECK(orbit->rounding(100) < 1e-11);
}

TEST_CASE("a liquid is compared as far as its positions are told, against a truth in double precision",
          "[compare][predictability]") {
  const Scene scene = melt(2, 8000);
  CompareOptions options;
  options.methods = {"verlet", "blanes_moan_s6"};
  options.repeats = 1;
  options.truth.budget = 4;
  const Comparison c = compare(scene, options);
  INFO(c.limits << "\n" << c.truth.note);
  REQUIRE(c.scene_end.value() == 40);
  CHECK(c.end < 30);
  CHECK(c.limits.find("the motion is chaotic") != std::string::npos);
  REQUIRE(c.truth.kind == TruthKind::doubles);
  CHECK(c.truth.error.value() < 1e-5);
  REQUIRE(c.position_measured);
  for (const Row& row : c.rows) {
    if (!row.completed()) continue;
    CHECK(row.position_error_max.value() > 0);
  }
  // What is asked for by name is not shortened.
  options.until = 1;
  CHECK(compare(scene, options).end == 1);
}

TEST_CASE("advice on a liquid is about its energy, and names the best where nothing holds", "[advise]") {
  const Scene scene = melt(2, 8000);
  AdviseOptions options;
  options.error = 1e-5;
  options.methods = {"verlet", "blanes_moan_s6"};
  options.row_budget = 1;
  const Advice advice = advise(scene, options);
  INFO(to_text(advice, scene));
  CHECK(advice.metric == Metric::energy);
  CHECK(advice.metric_reason.find("the motion is chaotic") != std::string::npos);
  CHECK_FALSE(advice.proposals.empty());

  options.error = 1e-13;
  options.methods = {"verlet"};
  options.metric = Metric::energy;
  const Advice none = advise(scene, options);
  CHECK(none.proposals.empty());
  REQUIRE(none.best);
  CHECK(none.best->who.label == "verlet");
  CHECK(none.best_error > 1e-13);
  CHECK(none.best->predicted_wall_s > 0);
  CHECK(to_text(none, scene).find("best found: verlet with a step of ") != std::string::npos);
}

TEST_CASE("advice on a liquid takes no more evaluations of forces than the run that it is about, and names a method",
          "[advise]") {
  const Scene scene = melt(7, 3000);  // 1372 atoms: the run itself takes 3000 evaluations
  AdviseOptions options;
  options.error = 1e-3;
  options.row_budget = 600;  // the clock decides nothing
  const Advice advice = advise(scene, options);
  INFO(to_text(advice, scene));
  const Allowance& work = advice.trials.work;
  CHECK(work.own_run == 3000);
  CHECK(work.most == 3000);
  CHECK(work.spent <= 3000);
  CHECK(work.spent > 500);
  double rows = 0;
  for (const Row& row : advice.trials.rows) rows += row.work;
  CHECK(rows > 300);
  CHECK(rows < work.spent);  // what is tried before the rows is counted too
  CHECK_FALSE(advice.proposals.empty());
  const std::string text = to_text(advice, scene);
  CHECK(text.find(" of 15, so that measuring stays within the 3000 evaluations of forces of the scene's own run") !=
        std::string::npos);
  CHECK(text.find("left out for the same reason: ") != std::string::npos);
}

TEST_CASE("few bodies are measured as before: their evaluations cost next to nothing", "[compare][advise]") {
  const Scene scene = kepler(0.2, "method = \"verlet\"\nstep = 0.02\nsteps = 1000");
  CompareOptions options;
  options.methods = {"verlet", "blanes_moan_s6", "dop853"};
  options.repeats = 1;
  const Comparison c = compare(scene, options);
  CHECK(c.end == 20);
  CHECK(c.limits.empty());
  CHECK(c.work.own_run == 1000);
  CHECK(c.work.spent > 10 * c.work.own_run);
  CHECK(c.work.spent < c.work.most);
  CHECK(c.truth.kind == TruthKind::quad);
}

TEST_CASE("positions of a liquid that nothing can hold are refused with the reason", "[advise][predictability]") {
  const Scene scene = melt(2, 8000);
  AdviseOptions options;
  options.error = 1e-5;
  options.metric = Metric::position;
  options.methods = {"verlet", "blanes_moan_s6"};
  options.row_budget = 1;
  options.truth.budget = 4;
  const Advice advice = advise(scene, options);
  INFO(to_text(advice, scene));
  CHECK(advice.proposals.empty());
  REQUIRE_FALSE(advice.hints.empty());
  CHECK(advice.hints[0].find("it is chaotic") != std::string::npos);
  CHECK(advice.hints[0].ends_with("the energy can be held: --metric energy"));
  CHECK(advice.best);
}

TEST_CASE("a step beyond what was tried is proposed by the measured order", "[advise]") {
  const Scene scene = oscillator("method = \"verlet\"\nstep = 0.1\nsteps = 400");
  AdviseOptions options;
  options.error = 1e-8;
  options.metric = Metric::energy;
  options.methods = {"verlet"};
  const Advice advice = advise(scene, options);
  INFO(to_text(advice, scene));
  CHECK(advice.proposals.empty());
  REQUIRE(advice.would_hold);
  CHECK(std::abs(advice.would_hold->order - 2) < 0.1);
  // The energy error of leapfrog on the oscillator is about (h omega)^2 / 8.
  CHECK(advice.would_hold->setting.step < 4e-4);
  CHECK(advice.would_hold->setting.step > 5e-5);
}

}  // namespace
}  // namespace noether::test

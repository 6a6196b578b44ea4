// The limit of multiple time steps: theory against the closed form of two springs, and runs against theory.

#include "study/kick_shares.hpp"
#include "study/set_lines.hpp"
#include "study/stability.hpp"
#include "study/suite.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace noether::test {
namespace {

const std::string suite_file = std::string(NOETHER_SOURCE_DIR) + "/study/suite/multiple_time_steps.toml";

/// Steps of the suite's bond, Omega = 1, with a slow spring lambda = 0.05 and 20 inner steps: half the trace of a step
/// in closed form, cos(n theta) - lambda h / 2 w sin(n theta).
double half_trace(double h) {
  const double inner = h / 20, theta = std::acos(1 - inner * inner / 2), w = std::sin(theta) / inner;
  return std::cos(20 * theta) - 0.05 * h / (2 * w) * std::sin(20 * theta);
}

/// The h between two others from which on a condition holds.
double first_where(const std::function<bool(double)>& holds, double low, double high) {
  while (high - low > 1e-12) {
    const double middle = (low + high) / 2;
    (holds(middle) ? high : low) = middle;
  }
  return high;
}
const double first_unstable = first_where([](double h) { return half_trace(h) < -1; }, 2.5, 3.05);

Scene chain_of_three(const std::string& second) {
  return read_scene(R"(units = "reduced"
[particles]
body = [{ name = "a", mass = 1, x = [0, 0, 0], v = [0, 0, 0] }, { name = "b", mass = 1, x = [1, 0, 0], v = [0, 1, 0] },
        { name = "c", mass = 1, x = [2, 0, 0], v = [0, 0, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "harmonic_bond"
pairs = [["a", "b"]]
k = 5
[[hamiltonian.force]]
type = "harmonic_bond"
pairs = [)" + second + R"(]
kick = "C"
k = 1
[integrator]
method = "respa"
inner_steps = [4]
step = 0.1
steps = 100
)",
                    "chain.toml");
}

}  // namespace

TEST_CASE("each kick has its part of the stiffness of the fastest mode, where that is a mode of each",
          "[stability][respa]") {
  const std::map<char, double> shares = kick_shares(load_scene(suite_file));
  REQUIRE(shares.size() == 2);
  CHECK(std::abs(shares.at('B') - 1 / 1.05) < 1e-9);
  CHECK(std::abs(shares.at('C') - 0.05 / 1.05) < 1e-9);
  const std::map<char, double> parallel = kick_shares(chain_of_three(R"(["a", "b"])"));
  REQUIRE(parallel.size() == 2);
  CHECK(std::abs(parallel.at('B') - 5.0 / 6) < 1e-9);
  const Scene bent = chain_of_three(R"(["b", "c"])");
  CHECK(kick_shares(bent).empty());
  const Mode mode = mode_of(bent, spectrum_at(bent, bent.particles));
  CHECK_FALSE(linear_theory(bent, fixed_candidate(bent, "respa"), mode).known);
  CHECK(linear_theory(bent, fixed_candidate(bent, "verlet"), mode).known);  // all kicks at one place
}

TEST_CASE("linear theory has the resonance of multiple time steps where the closed form has it", "[stability][respa]") {
  const Scene scene = load_scene(suite_file);
  const Mode mode = mode_of(scene, spectrum_at(scene, scene.particles));
  CHECK(std::abs(mode.omega - std::sqrt(1.05)) < 1e-9);
  const auto matrix = step_matrix(scene, fixed_candidate(scene, "respa"), mode);
  REQUIRE(matrix);
  for (const double h : {0.1, 1.0, 2.9, 3.08, 3.2, 5.0})
    CHECK(std::abs((*matrix)(h * mode.omega).trace() / 2 - half_trace(h)) < 1e-9);
  const LinearTheory theory = linear_theory(scene, fixed_candidate(scene, "respa"), mode);
  REQUIRE(theory.limit);
  REQUIRE(theory.gap_end);
  CHECK(std::abs(*theory.limit / mode.omega - first_unstable) < 1e-4);
  CHECK(std::abs(*theory.gap_end / mode.omega - 40 * std::sin(M_PI / 40)) < 1e-4);  // n theta = pi
}

TEST_CASE("studies count the evaluations of each kick, and leave inner steps to their method", "[respa]") {
  const Scene scene = load_scene(suite_file);
  const Candidate own = fixed_candidate(scene, "respa"), other = fixed_candidate(scene, "verlet");
  CHECK(evaluations_per_step(scene, own, 1) == 21);
  CHECK(evaluations_per_step(scene, other, 1) == 2);
  CHECK(variant(scene, own, {.step = 1}).integrator.composition.inner_steps == InnerSteps{20});
  const std::vector<std::string> lines = set_lines(scene, other, {.step = 1}, 100).lines;
  CHECK(std::find(lines.begin(), lines.end(), "integrator.inner_steps=") != lines.end());
}

TEST_CASE("the suite's multiple time steps do what their verdicts say", "[stability][respa]") {
  const Suite suite = run_suite({suite_file});
  CHECK(suite.rows.size() == 8);
  for (const SuiteRow& row : suite.rows) {
    CAPTURE(row.method, row.sets, row.expected, row.found, row.message);
    CHECK(row.agrees);
  }
}

TEST_CASE("stability finds the resonance of multiple time steps by runs", "[stability][respa][slow]") {
  StabilityOptions options;
  options.methods = {"respa"};
  options.row_budget = 300;
  options.confirm_steps = 20000;
  const StabilityRow row = find_stability(load_scene(suite_file), options).rows.at(0);
  REQUIRE(row.limit_step);
  CAPTURE(row.reason, row.message);
  CHECK(std::abs(*row.limit_step - first_unstable) < 1e-3);
  CHECK(row.reason == "linear");
}

}  // namespace noether::test

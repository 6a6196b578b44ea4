// Fronts and slopes, on points made for the purpose.

#include "study/analysis.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace noether::test {
namespace {

TEST_CASE("the front is what nothing else beats in both", "[analysis]") {
  const std::vector<std::optional<double>> cost = {1, 2, 3, 2, std::nullopt, 4},
                                           error = {1e-2, 1e-4, 1e-3, 1e-4, 1e-9, std::nullopt};
  CHECK(pareto_front(cost, error) == std::vector<bool>{true, true, false, true, false, false});
  // Same error, higher cost; same cost, larger error.
  CHECK(pareto_front({1, 2}, {1e-5, 1e-5}) == std::vector<bool>{true, false});
  CHECK(pareto_front({1, 1}, {1e-5, 1e-6}) == std::vector<bool>{false, true});
}

std::vector<std::pair<double, double>> errors(double order, double factor, double rounding) {
  std::vector<std::pair<double, double>> points;
  for (double h = 1; h > 1e-3; h /= 2) points.emplace_back(h, factor * std::pow(h, order) + rounding / h);
  return points;
}

TEST_CASE("an order is the slope between coarse steps and rounding", "[analysis]") {
  for (const double order : {1.0, 2.0, 4.0, 8.0}) {
    const auto law = asymptotic_fit(errors(order, 0.5, 1e-16), 1e-13);
    REQUIRE(law);
    CHECK(std::abs(law->exponent - order) < 0.05);
    CHECK(std::abs((*law)(0.01) / (0.5 * std::pow(0.01, order)) - 1) < 0.3);
  }
  // Rounding alone has no order.
  CHECK_FALSE(asymptotic_fit({{0.1, 1e-15}, {0.05, 2e-15}, {0.025, 1e-15}}, 1e-13));
  CHECK_FALSE(asymptotic_fit({{0.1, 1e-3}}, 1e-13));
  // Coarse steps that have not begun to converge do not count.
  auto points = errors(4, 1, 0);
  points.insert(points.begin(), {{8, 0.09}, {4, 0.08}, {2, 0.085}});
  const auto law = asymptotic_fit(points, 1e-13);
  REQUIRE(law);
  CHECK(std::abs(law->exponent - 4) < 0.05);
}

Row row(const Candidate& who, const std::string& outcome, double seconds, std::int64_t evaluations, double error) {
  Row made{.who = who};
  made.outcome = outcome;
  made.wall_s = seconds;
  made.evaluations.force = evaluations;
  made.position_error_max = error;
  return made;
}

TEST_CASE("a comparison marks both fronts, and rows that have failed stand on none", "[analysis]") {
  Comparison c;
  const Candidate one{"one", "one", {}, false}, other{"other", "other", {}, false};
  c.methods = {one, other};
  c.position_measured = true;
  c.rows = {row(one, "completed", 1, 100, 1e-3),       row(one, "completed", 2, 400, 1e-5),
            row(other, "completed", 3, 300, 1e-5),     row(other, "diverged", 0.1, 10, 1e-12),
            row(other, "over_budget", 0.1, 10, 1e-12), row(other, "completed", 0.1, 10, 1)};
  analyse(c);
  std::vector<bool> by_time, by_evaluations;
  for (const Row& each : c.rows) {
    by_time.push_back(each.pareto_time);
    by_evaluations.push_back(each.pareto_evaluations);
  }
  CHECK(by_time == std::vector<bool>{true, true, false, false, false, false});
  CHECK(by_evaluations == std::vector<bool>{true, false, true, false, false, false});
}

}  // namespace
}  // namespace noether::test

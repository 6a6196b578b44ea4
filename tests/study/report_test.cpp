// Reports of stability: pictures that are well-formed, a mark for every result, and what differs can be seen.

#include "study/report.hpp"
#include "study/compare.hpp"
#include "study/row_plot.hpp"
#include "study/stability.hpp"
#include "study/suite.hpp"
#include "tests/study/scenes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/process.hpp"
#include "tests/support/xml.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace noether::test {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++found;
  return found;
}

/// The pictures of a page, each of them well-formed, of a page that needs nothing from elsewhere.
std::vector<std::string> pictures(const std::string& page) {
  CHECK(page.starts_with("<!DOCTYPE html>"));
  for (const char* foreign : {"http://", "https://", "src=", "@import", "url("}) CHECK(count(page, foreign) == 0);
  std::vector<std::string> found;
  for (const std::string& svg : elements(page, "<svg", "svg")) {
    INFO(svg);
    CHECK(XmlCheck(svg).whole());
    if (svg.starts_with("<svg class=\"plot\"")) found.push_back(svg);
  }
  return found;
}

SuiteRow verdict(const std::string& method, const std::string& found, bool agrees, std::vector<std::string> sets = {}) {
  SuiteRow row;
  row.scene = "spring.toml";
  row.title = "A <spring> & more";
  row.method = method;
  row.sets = std::move(sets);
  row.expected = "bounded";
  row.found = found;
  row.agrees = agrees;
  return row;
}

StabilityRow limit(const std::string& method, std::optional<double> measured, std::optional<double> theory,
                   bool settled = true) {
  StabilityRow row;
  row.who.label = method;
  row.limit_step = row.limit_h_omega = measured;
  row.theory.known = true;
  row.theory.limit = theory;
  row.reason = measured ? "linear" : "none";
  row.settled = settled;
  return row;
}

Stability search_of(std::vector<StabilityRow> rows) {
  Stability found;
  found.title = "A <spring> & more";
  found.time_unit = "1";
  found.spectrum.fastest = found.mode.omega = 1;
  found.rows = std::move(rows);
  return found;
}

TEST_CASE("the check of XML finds what is not well-formed", "[report]") {
  CHECK(XmlCheck("<a b=\"1\" c=\"x &amp; y\"><d/>text<e>&lt;</e></a>").whole());
  for (const char* bad : {"<a><b></a></b>", "<a>", "<a>&</a>", "<a>&nbsp;</a>", "<a b=1/>", "<a b=\"1\" b=\"2\"/>",
                          "<a b=\"<\"/>", "<a/><b/>", "<a></a >x", ""}) {
    CAPTURE(bad);
    CHECK_FALSE(XmlCheck(bad).whole());
  }
}

TEST_CASE("the report of the suite has a picture for every scene and a mark for every verdict", "[report]") {
  Suite suite;
  suite.rows = {verdict("verlet", "bounded", true, {"integrator.step=0.1"}),
                verdict("verlet", "unbounded", true, {"integrator.step=2.1"}),
                verdict("verlet", "bounded", false, {"integrator.step=2.1"}),  // asked twice
                verdict("rk4", "solver", false, {"integrator.step=0.1"}),
                verdict("rk4", "bounded", true, {"integrator.step=0.1"}),
                verdict("a<b>&c", "unsettled", true, {"particles.body.a.mass=1", "particles.body.b.mass=2"})};
  suite.rows.push_back(verdict("euler", "unbounded", true));
  suite.rows.back().scene = "other.toml";
  const std::string page = to_html(suite);
  const std::vector<std::string> found = pictures(page);
  REQUIRE(found.size() == 2);
  CHECK(count(found[0], "<g class=\"row") == 3);
  CHECK(count(found[0], "<g class=\"verdict") == 6);
  CHECK(count(found[0], "<g class=\"verdict alarm\">") == 2);
  CHECK(count(found[0], "<g class=\"row alarm\"") == 2);
  CHECK(count(found[1], "<g class=\"verdict\">") == 1);
  CHECK(count(found[1], "alarm") == 0);
  std::vector<std::string> columns;
  for (const std::string& text : elements(found[0], "<text class=\"name\"", "text")) {
    columns.push_back(text.substr(text.find('>') + 1, text.find("</") - text.find('>') - 1));
  }
  CHECK(columns ==
        std::vector<std::string>{"step = 0.1", "step = 0.1", "step = 2.1", "step = 2.1", "a.mass = 1, b.mass = 2"});
  CHECK(count(found[0], "data-name=\"a&lt;b&gt;&amp;c\"") == 1);
  CHECK(count(page, "5 of 7 verdicts hold") == 1);
  CHECK(count(page, "<spring>") == 0);
}

TEST_CASE("bounded runs whose errors are beyond a bound look unlike those that are kept", "[report]") {
  const auto mark = [](Finding finding) {
    return elements(verdicts_svg({"c"}, {{"m", {{.column = 0, .finding = finding}}}}), "<g class=\"verdict", "g").at(0);
  };
  const std::vector<Finding> all = {Finding::kept, Finding::inaccurate, Finding::unbounded, Finding::unsolved,
                                    Finding::unsettled};
  for (const Finding one : all) {
    for (const Finding other : all) CHECK((mark(one) == mark(other)) == (one == other));
  }
}

TEST_CASE("the suite tells inaccurate runs from kept ones by the bounds of their verdicts", "[report]") {
  const ScratchFolder folder;
  write_text(folder / "spring.toml", R"(units = "reduced"
[particles]
body = [{ name = "bob", mass = 1, x = [1, 0, 0], v = [0, 0, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "harmonic_field"
k = 1
[integrator]
method = "verlet"
step = 0.2
steps = 2000
[[verdict]]
energy_below = 0.1
[[verdict]]
energy_below = 0.1
energy_above = 1e-6
[[verdict]]
energy_above = 1e-6
[[verdict]]
energy_below = 1e-6
)");
  const Suite suite = run_suite({folder / "spring.toml"});
  REQUIRE(suite.rows.size() == 4);
  CHECK(suite.agreeing() == 3);  // leapfrog's error is h^2/4 at most, 1e-2
  CHECK(suite.rows[0].accurate);
  CHECK(suite.rows[1].accurate);
  CHECK_FALSE(suite.rows[2].accurate);
  CHECK_FALSE(suite.rows[3].accurate);
}

TEST_CASE("the suite begins at the minimum that a scene asks for", "[report]") {
  const ScratchFolder folder;
  const std::string scene = R"(units = "reduced"
[particles]
body = [{ name = "bob", mass = 1, x = [3, 0, 0], v = [0, 0, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "harmonic_field"
k = 1
[[hamiltonian.force]]
type = "uniform_field"
acceleration = [1, 0, 0]
)";
  const std::string run = R"([integrator]
method = "verlet"
step = 0.2
steps = 2000
[[verdict]]
energy_below = 1e-9
)";
  write_text(folder / "swings.toml", scene + run);
  write_text(folder / "rests.toml", scene + "[minimize]\nmax_force = 1e-9\n" + run);
  write_text(folder / "lost.toml", scene + "[minimize]\nmax_force = 1e-9\nsteps = 2\n" + run);
  CHECK(run_suite({folder / "swings.toml"}).agreeing() == 0);
  CHECK(run_suite({folder / "rests.toml"}).agreeing() == 1);
  CHECK_THROWS_WITH(run_suite({folder / "lost.toml"}), Catch::Contains("none is found"));
}

TEST_CASE("the report of a search marks every limit, and those off theory in a way that shows", "[report]") {
  Stability search = search_of({limit("verlet", 2, 2), limit("near", 1.99, 2), limit("far", 1.9, 2),
                                limit("<b>", 1.7, {}), limit("unlimited", {}, 2), limit("free", {}, {}),
                                limit("unsettled", 1.2, 2, false), limit("stopped", {}, 2, false)});
  search.rows.back().bounded_until = 0.7;
  const std::vector<bool> differ = {false, false, true, true, true, false, false, false};
  const std::string page = to_html(search);
  const std::vector<std::string> found = pictures(page);
  REQUIRE(found.size() == 1);
  CHECK(count(found[0], "class=\"measured\"") == search.rows.size());
  CHECK(count(found[0], "class=\"theory\"") == search.rows.size());
  const std::vector<std::string> rows = elements(found[0], "<g class=\"row", "g");
  REQUIRE(rows.size() == search.rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    CAPTURE(search.rows[k].who.label);
    CHECK(differs_from_theory(search.rows[k]) == differ[k]);
    CHECK((count(rows[k], "class=\"row alarm\"") == 1) == differ[k]);
    CHECK((count(rows[k], "stroke-dasharray") == 1) == differ[k]);
    CHECK((count(rows[k], ", theory ") == 1) == differ[k]);
  }
  CHECK(count(rows.back(), ">bounded to 0.7, not settled<") == 1);
  CHECK(number_after(rows.back(), "<circle cx=\"") < number_after(rows[6], "<circle cx=\""));
  CHECK(count(page, "<b>") == 0);
}

TEST_CASE("limits stand where the axis says, linear over less than a decade, else logarithmic", "[report]") {
  const auto places = [](const std::vector<double>& limits) {
    std::vector<LimitRow> rows;
    for (const double z : limits) rows.push_back({.label = "m", .measured = z, .theory = z});
    const std::string svg = limits_svg("h", rows);
    std::vector<double> found;
    for (std::size_t k = 0; k < limits.size(); ++k) {
      found.push_back(number_after(svg, "<circle cx=\"", k));
      CHECK(std::abs(number_after(svg, "<path class=\"theory\" d=\"M", k) - found.back()) < 1e-9);
    }
    return found;
  };
  const std::vector<double> linear = places({1, 2, 3}), logarithmic = places({0.2, 2, 20});
  CHECK(linear[1] - linear[0] > 100);
  CHECK(std::abs(linear[2] - 2 * linear[1] + linear[0]) < 0.21);
  CHECK(logarithmic[1] - logarithmic[0] > 100);
  CHECK(std::abs(logarithmic[2] - 2 * logarithmic[1] + logarithmic[0]) < 0.21);
}

TEST_CASE("pictures of nothing and of what has no limits are well-formed too", "[report]") {
  for (const std::string& svg : {limits_svg("h", {}), limits_svg("h", {{.label = "m"}}), verdicts_svg({}, {})}) {
    INFO(svg);
    CHECK(XmlCheck(svg.substr(0, svg.size() - 1)).whole());
    CHECK(count(svg, "nan") == 0);
    CHECK(count(svg, "inf") == 0);
  }
}

TEST_CASE("the pictures of a comparison are well-formed", "[report][compare]") {
  const Scene scene = oscillator("method = \"verlet\"\nstep = 0.1\nsteps = 400");
  CompareOptions options;
  options.methods = {"verlet", "rk4"};
  options.steps = {0.1, 0.05};
  options.repeats = 1;
  CHECK(pictures(report_html(compare(scene, options))).size() >= 3);
}

TEST_CASE("the report of a comparison has its fronts, its orders and its errors over time", "[report][compare]") {
  const Scene scene = kepler(0.1, "method = \"verlet\"\nstep = 0.05\nsteps = 400");
  CompareOptions options;
  options.methods = {"verlet", "yoshida_4", "dop853"};
  options.steps = {0.1, 0.05, 0.025};
  options.tolerances = {1e-5, 1e-8};
  options.repeats = 1;
  const Comparison c = compare(scene, options);
  const std::string page = report_html(c);
  const std::vector<std::string> found = pictures(page);
  REQUIRE(found.size() == 4);
  // Rings, and a broad line through them, in the pictures against time and against evaluations.
  for (const bool by_time : {true, false}) {
    const std::string& svg = found[by_time ? 0 : 1];
    const auto on_front = std::count_if(c.rows.begin(), c.rows.end(), [&](const Row& row) {
      return by_time ? row.pareto_time : row.pareto_evaluations;
    });
    CAPTURE(by_time, on_front);
    REQUIRE(on_front >= 2);
    CHECK(static_cast<std::ptrdiff_t>(count(svg, "<circle class=\"ring\"")) == on_front);
    REQUIRE(count(svg, "<path class=\"front\"") == 1);
    const std::size_t line = svg.find("<path class=\"front\"");
    const std::string front = svg.substr(line, svg.find("/>", line) - line);
    CHECK(static_cast<std::ptrdiff_t>(count(front, "H")) == on_front - 1);
    for (const Candidate& who : c.methods) {
      CHECK(count(svg, "<g class=\"curve\" data-name=\"" + who.label + "\">") == 1);
    }
  }
  // The table of orders has a row for each method, with its fit.
  const std::size_t begin = page.find("<h2>Orders</h2>"), end = page.find("</table>", begin);
  REQUIRE(begin != std::string::npos);
  const std::string orders = page.substr(begin, end - begin);
  REQUIRE(c.orders.size() == 3);
  CHECK(count(orders, "<tr data-name=") == 3);
  for (const OrderFit& fit : c.orders) {
    CAPTURE(fit.label);
    const std::string row = elements(orders, "<tr data-name=\"" + fit.label + "\"", "tr")[0];
    CHECK(count(row, fit.order ? fmt::format("<td>{:.2f}</td>", *fit.order) : "<td></td>") >= 1);
    CHECK(count(row, fmt::format("<td>{}</td>", fit.rows)) >= 1);
  }
  CHECK(std::abs(c.orders[0].order.value() - 2) < 0.25);
  // Then a curve of each method over time, of energies and of positions.
  const std::size_t energies = page.find("<h2>Energy error over time</h2>"),
                    positions = page.find("<h2>Position error over time</h2>");
  REQUIRE(energies != std::string::npos);
  REQUIRE(positions != std::string::npos);
  CHECK(page.find(found[2]) > energies);
  CHECK(page.find(found[2]) < positions);
  CHECK(page.find(found[3]) > positions);
  CHECK(count(found[2], "aria-label=\"relative error of the energy against time\"") == 1);
  CHECK(count(found[2], "<g class=\"curve\"") == 3);
  CHECK(count(found[3], "<g class=\"curve\"") == 3);
}

}  // namespace
}  // namespace noether::test

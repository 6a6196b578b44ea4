// Comparisons of small scenes: known slopes, failed rows, and what is written of them.

#include "integrators/systems/forced_damped_oscillator.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "study/compare_files.hpp"
#include "study/report.hpp"
#include "tests/study/scenes.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace noether::test {
namespace {

const OrderFit& order_of(const Comparison& c, const std::string& label) {
  const auto found =
      std::find_if(c.orders.begin(), c.orders.end(), [&](const OrderFit& fit) { return fit.label == label; });
  REQUIRE(found != c.orders.end());
  return *found;
}

TEST_CASE("methods show their orders on a Kepler orbit, by fixed steps and by tolerances", "[compare]") {
  const Scene scene = kepler(0.1, "method = \"verlet\"\nstep = 0.05\nsteps = 800");
  CompareOptions options;
  options.methods = {"verlet", "yoshida_4", "blanes_moan_s6", "kahan_li_8_s17", "rk4", "dop853"};
  options.steps = {0.2, 0.1, 0.05, 0.025, 0.0125};
  options.tolerances = {1e-5, 1e-7, 1e-9, 1e-11};
  options.repeats = 1;
  const Comparison c = compare(scene, options);
  REQUIRE(c.position_measured);
  CHECK(c.rows.size() == 5 * 5 + 4);
  for (const auto& [label, order] :
       {std::pair("verlet", 2), std::pair("yoshida_4", 4), std::pair("blanes_moan_s6", 4)}) {
    INFO(label);
    const OrderFit& fit = order_of(c, label);
    REQUIRE(fit.order);
    CHECK(fit.rows >= 3);
    CHECK(std::abs(*fit.order - order) < 0.25);
  }
  CHECK(std::abs(order_of(c, "kahan_li_8_s17").order.value() - 8) < 0.6);
  // What drifts with the energy falls by one order more, and comes to lead on long runs.
  CHECK(order_of(c, "rk4").order.value() > 3.8);
  CHECK(order_of(c, "rk4").order.value() < 5.2);
  CHECK(order_of(c, "dop853").order.value() > 7.5);
  for (const Row& row : c.rows) {
    INFO(row.who.label << " " << row.setting.step << " " << row.setting.tolerance);
    CHECK(row.completed());
    CHECK(std::abs(row.outcome_time / c.end - 1) < 1e-9);
    CHECK(row.track.y.size() == 201);
    CHECK(row.position_error_max.value() >= row.position_error_rms.value());
    CHECK(row.truth_error.value() < 1e-15);
    CHECK(row.evaluations.force > 0);
    CHECK(row.repeats >= 1);
    CHECK(row.momentum_error_max.value() < 1e-13);
  }
}

TEST_CASE("steps divide the time between two moments, and errors shrink with the steps", "[compare]") {
  const Scene scene = kepler(0, "method = \"verlet\"\nstep = 0.01\nsteps = 2000");
  const Sampling sampling = sampling_of(scene, {});
  CHECK(sampling.interval == 0.1);
  CompareOptions options;
  options.steps = {0.013, 0.0249, 0.025, 0.1};
  const auto settings = settings_of(scene, candidate(scene, "verlet"), sampling, options);
  REQUIRE(settings.size() == 3);
  CHECK(settings[0].step == 0.1);
  CHECK(settings[1].step == 0.1 / 4);
  CHECK(settings[2].step == 0.1 / 8);
}

TEST_CASE("by default a ladder of six steps costs as much for every method", "[compare]") {
  const Scene scene = kepler(0, "method = \"verlet\"\nstep = 0.01\nsteps = 2000");
  const Sampling sampling = sampling_of(scene, {});
  const auto verlet = settings_of(scene, candidate(scene, "verlet"), sampling, {});
  const auto rk4 = settings_of(scene, candidate(scene, "rk4"), sampling, {});
  REQUIRE(verlet.size() == 6);
  CHECK(std::abs(verlet.front().step / 0.04 - 1) < 0.3);
  CHECK(std::abs(verlet.back().step / 0.00125 - 1) < 0.01);
  REQUIRE(rk4.size() >= 5);
  CHECK(std::abs(rk4.back().step / 0.005 - 1) < 0.01);
  CHECK(settings_of(scene, candidate(scene, "dop853"), sampling, {}).size() == 6);
}

TEST_CASE("a run that diverges is a row, and so is one beyond its budget", "[compare]") {
  const Scene scene = oscillator("method = \"verlet\"\nstep = 0.1\nsteps = 100000");
  CompareOptions options;
  options.until = 2000;
  options.methods = {"verlet"};
  options.steps = {2.5, 0.1};
  options.repeats = 2;
  const Comparison c = compare(scene, options);
  REQUIRE(c.rows.size() == 2);
  CHECK(c.rows[0].outcome == "diverged");
  CHECK(c.rows[0].outcome_time < 2000);
  CHECK_FALSE(c.rows[0].pareto_time);
  CHECK(c.rows[1].completed());
  CHECK(c.rows[1].repeats >= 2);
  options.steps = {1e-5};
  options.row_budget = 0.02;
  const Comparison slow = compare(scene, options);
  CHECK(slow.rows[0].outcome == "over_budget");
  CHECK(slow.rows[0].outcome_time > 0);
  CHECK(slow.rows[0].outcome_time < 2000);
  CHECK(slow.rows[0].repeats == 0);
}

/// The heat equation on a line of 16 points, whose fastest rate is about 1150; explicit Euler needs steps below 2/1150.
Scene heat_line() {
  return read_scene(R"(units = "reduced"
[system]
type = "heat_line"
points = 16
[integrator]
method = "euler"
step = 1e-3
until = 2
)",
                    "heat.toml");
}

TEST_CASE("a run far beyond its limit has diverged, though its numbers are still finite", "[compare]") {
  CompareOptions options;
  options.methods = {"euler"};
  options.steps = {0.01, 1e-3};
  options.repeats = 1;
  const Comparison c = compare(heat_line(), options);
  REQUIRE(c.truth.kind == TruthKind::quad);
  REQUIRE(c.rows.size() == 2);
  CHECK(c.rows[1].completed());
  const Row& lost = c.rows[0];
  INFO(lost.message);
  CHECK(lost.steps == 200);
  CHECK(std::isfinite(lost.track.y.back()[0]));
  CHECK(std::abs(lost.track.y.back()[0]) > 1e100);
  CHECK(lost.outcome == "diverged");
  CHECK(lost.outcome_time < 0.5);
  CHECK(lost.message.find(" times as large as the reference ever is at t = ") != std::string::npos);
  CHECK_FALSE(lost.position_error_end);
  CHECK_FALSE(lost.pareto_time);
  CHECK_FALSE(lost.pareto_evaluations);
  // Without a truth the start is the measure, and the factor far larger.
  options.truth.budget = 1e-9;
  const Comparison alone = compare(heat_line(), options);
  REQUIRE_FALSE(alone.truth.has_states());
  CHECK(alone.rows[0].outcome == "diverged");
  CHECK(alone.rows[0].message.find(" times as large as at the start at t = ") != std::string::npos);
  CHECK(alone.rows[0].outcome_time > 2 * lost.outcome_time);
  CHECK(alone.rows[1].completed());
}

TEST_CASE("the run that is timed has the bits of the one that is watched", "[compare]") {
  const Scene scene = kepler(0.3, "method = \"verlet\"\nstep = 0.01\nsteps = 200");
  const Sampling sampling = sampling_of(scene, {});
  const Candidate who = candidate(scene, "yoshida_4");
  const Row row = measure(scene, who, {.step = 0.01, .tolerance = 0}, sampling, {.repeats = 1, .budget = 10});
  Simulation<double> alone = assemble(variant(scene, who, row.setting));
  REQUIRE(alone.run(row.steps).ok());
  CHECK(row.evaluations.force == alone.evaluations().force);
  CHECK(row.track.y.back()[1] == alone.particles().positions()[1][0]);
}

TEST_CASE("of repeated runs the median is told, and the median distance from it", "[compare]") {
  const auto check = [](const std::vector<double>& values, double median, double mad) {
    const Spread spread = spread_of(values);
    CHECK(spread.median == median);
    CHECK(spread.mad == mad);
  };
  check({3}, 3, 0);
  check({5, 1, 2}, 2, 1);
  check({1, 4, 2, 8}, 3, 1.5);
  check({1, 1, 1, 1000}, 1, 0);  // one interruption decides nothing
  check({9, 1, 1, 5, 2}, 2, 1);
  const Scene scene = kepler(0.3, "method = \"verlet\"\nstep = 0.01\nsteps = 200");
  const Row row = measure(scene, candidate(scene, "verlet"), {.step = 0.01, .tolerance = 0}, sampling_of(scene, {}),
                          {.repeats = 3, .budget = 10});
  CHECK(row.repeats > 3);  // it is soon over
  CHECK(row.repeats <= 15);
  CHECK(row.wall_s.value() > 0);
  CHECK(row.wall_mad_s.value() < row.wall_s.value());
}

TEST_CASE("a row tells how far the shadow of its run fluctuates, where it can have one", "[compare]") {
  const Scene scene = kepler(0.1, "method = \"verlet\"\nstep = 0.05\nsteps = 1600");
  CompareOptions options;
  options.methods = {"verlet", "rk4", "dop853"};
  options.steps = {0.4, 0.01};
  options.tolerances = {1e-6};
  options.repeats = 1;
  Comparison c = compare(scene, options);
  REQUIRE(c.rows.size() == 5);
  CHECK_FALSE(c.rows[0].shadow_fluctuation);  // one step between two moments
  CHECK_FALSE(c.rows[2].shadow_fluctuation);  // not symplectic
  CHECK_FALSE(c.rows[3].shadow_fluctuation);
  CHECK_FALSE(c.rows[4].shadow_fluctuation);
  const Row row = c.rows[1];
  REQUIRE(row.shadow_fluctuation);
  CHECK(*row.shadow_fluctuation < 1e-6 * row.energy_error_rms.value());
  // The least of those of all orders, as a monitor of its own finds it.
  Simulation<double> alone = assemble(variant(scene, row.who, row.setting));
  const auto& monitor = alone.every(40, ShadowHamiltonian<double>());
  REQUIRE(alone.run(8000).ok());
  const std::vector<double> all = monitor.report().fluctuation;
  CHECK(*row.shadow_fluctuation == *std::min_element(all.begin(), all.end()));
  c.rows = {row};
  const std::string csv = to_csv(c);
  CHECK(csv.find(fmt::format(",{},{},", *row.shadow_fluctuation, row.truth)) != std::string::npos);
}

TEST_CASE("a wisdom_holman scene is compared with whole-gravity kicks too", "[compare]") {
  const Scene scene = outer_solar_system();
  CHECK(candidate(scene, "verlet").label == "verlet");
  CHECK(candidate(scene, "verlet@kinetic_potential").label == "verlet@kinetic_potential");
  CHECK(candidate(scene, "srkn14a").label == "srkn14a");
  CHECK(candidate(scene, "rk4").label == "rk4");
  const std::vector<Candidate> all = default_opponents(scene);
  CHECK(all.size() >= 8);
  CHECK(all.front().label == "aba_10_6_4");
  CompareOptions options;
  options.until = 40000;
  options.methods = {"aba_10_6_4", "verlet@kinetic_potential"};
  options.steps = {100};
  options.repeats = 1;
  const Comparison c = compare(scene, options);
  REQUIRE(c.rows.size() == 2);
  CHECK(c.rows[0].evaluations.kepler > 0);
  CHECK(c.rows[1].evaluations.kepler == 0);
  // Both go to the same place, and Kepler arcs are better at it by orders of magnitude.
  CHECK(c.rows[1].position_error_max.value() < 1);
  CHECK(c.rows[0].position_error_max.value() < 1e-4 * c.rows[1].position_error_max.value());
  CHECK(c.scene_end.value() == 365250000);
}

TEST_CASE("a method that has two names over a Hamiltonian is compared once", "[compare]") {
  const auto opponents = [](const std::vector<std::string>& sets) {
    std::vector<std::string> labels;
    const Scene banana = load_scene(NOETHER_SOURCE_DIR "/examples/tokamak_banana/scene.toml", standard_parts(), sets);
    for (const Candidate& one : default_opponents(banana)) labels.push_back(one.label);
    return std::pair(std::count(labels.begin(), labels.end(), "verlet_aba"),
                     std::count(labels.begin(), labels.end(), "verlet"));
  };
  CHECK(opponents({}) == std::pair(1L, 0L));  // the basic word of Boris's kicks is A B A
  CHECK(opponents({"integrator.method=verlet"}) == std::pair(0L, 1L));
  CHECK(opponents({"hamiltonian.rotation=exact"}) == std::pair(1L, 1L));
}

/// Fewest force evaluations of a method's rows whose energy error stays below a bound.
std::int64_t evaluations_below(const Comparison& c, const std::string& label, double bound) {
  std::int64_t fewest = std::numeric_limits<std::int64_t>::max();
  for (const Row& row : c.rows) {
    if (row.who.label == label && row.completed() && row.energy_error_max.value_or(1) < bound) {
      fewest = std::min(fewest, row.evaluations.force);
    }
  }
  return fewest;
}

TEST_CASE("the outer Solar System has its known picture: arcs ahead at 1e-9, Gauss at rounding", "[compare][slow]") {
  CompareOptions options;
  options.until = 80000;
  options.methods = {"verlet", "aba_10_6_4", "verlet@kinetic_potential",
                     "rk4",    "heun",       "dormand_prince_5",
                     "dop853", "gauss_8",    "gauss_radau_15"};
  options.steps = {400, 200, 10, 5, 2, 0.2, 0.1};
  options.truth.budget = 1e-4;
  options.repeats = 1;
  const Comparison c = compare(outer_solar_system(), options);
  const auto cost = [&](const char* label) { return evaluations_below(c, label, 1e-9); };
  const std::int64_t arcs = cost("verlet"), best = cost("aba_10_6_4");
  CAPTURE(arcs, best, cost("verlet@kinetic_potential"), cost("rk4"), cost("dormand_prince_5"), cost("dop853"));
  CHECK(best <= 1600);
  CHECK(10 * arcs < cost("verlet@kinetic_potential"));
  CHECK(100 * best < cost("verlet@kinetic_potential"));
  CHECK(arcs < cost("rk4"));  // RK4 drifts: its error grows with the length of the run, that of arcs does not
  CHECK(arcs < cost("heun") / 10);
  CHECK(20 * best < cost("rk4"));
  CHECK(10 * best < cost("dormand_prince_5"));
  CHECK(3 * best < cost("dop853"));
  // At rounding: below the 1e-14 that others come to by steps a hundred times as short, or never.
  for (const char* gauss : {"gauss_8", "gauss_radau_15"}) {
    CAPTURE(gauss, evaluations_below(c, gauss, 1e-14));
    CHECK(evaluations_below(c, gauss, 1e-14) < 12000);
  }
  for (const char* other : {"verlet", "verlet@kinetic_potential", "rk4", "heun"}) {
    CAPTURE(other);
    CHECK(evaluations_below(c, other, 1e-14) > 100000);
  }
}

TEST_CASE("where there is no truth, the finest run stands in for it, and says so", "[compare]") {
  const Scene scene = kepler(0.3, "method = \"verlet\"\nstep = 0.05\nsteps = 400");
  CompareOptions options;
  options.methods = {"verlet", "kahan_li_8_s17"};
  options.steps = {0.05, 0.025, 0.0125};
  options.truth.budget = 1e-4;
  options.repeats = 1;
  const Comparison c = compare(scene, options);
  REQUIRE(c.truth.kind == TruthKind::finest_run);
  CHECK(c.rows[0].truth == "finest run");
  REQUIRE(c.reference);
  CHECK(c.rows[*c.reference].who.label == "kahan_li_8_s17");
  CHECK_FALSE(c.rows[*c.reference].position_error_max);
  CHECK(std::abs(order_of(c, "verlet").order.value() - 2) < 0.25);
  // The error it claims is about the error it has.
  options.truth.budget = 60;
  const Comparison exact = compare(scene, options);
  CHECK(exact.rows[*c.reference - 1].position_error_max.value() < 2 * *c.truth.error);
  CHECK(exact.rows[*c.reference - 1].position_error_max.value() > 0.5 * *c.truth.error);
}

TEST_CASE("the energy of a damped run is compared with that of the truth", "[compare]") {
  const Scene scene = oscillator("method = \"verlet\"\nstep = 0.05\nsteps = 400", 0.125);
  CompareOptions options;
  options.methods = {"verlet", "rk4"};
  options.steps = {0.1, 0.05, 0.025};
  options.repeats = 1;
  const Comparison c = compare(scene, options);
  for (const Row& row : c.rows) {
    REQUIRE(row.energy_error_max);
    CHECK(*row.energy_error_max < 1e-2);
    CHECK_FALSE(row.energy_slope);
  }
  CHECK(std::abs(std::log2(*c.rows[0].energy_error_max / *c.rows[1].energy_error_max) - 2) < 0.2);
  CHECK(std::abs(std::log2(*c.rows[3].energy_error_max / *c.rows[4].energy_error_max) - 4) < 0.3);
}

TEST_CASE("compare.csv has the columns that are promised, and one line for each row", "[compare][files]") {
  const Scene scene = oscillator("method = \"verlet\"\nstep = 0.1\nsteps = 400");
  CompareOptions options;
  options.methods = {"verlet", "rk4"};
  options.steps = {0.1, 0.05};
  options.repeats = 1;
  Comparison c = compare(scene, options);
  c.scene = "a, \"quoted\" scene.toml";
  const std::string csv = to_csv(c);
  CHECK(csv.starts_with(
      "scene,method,step,step_unit,tolerance,threads,simd,outcome,outcome_time,steps,rejected,force_evaluations,"
      "kepler_evaluations,jacobian_evaluations,wall_s,wall_mad_s,repeats,position_error_max,position_error_rms,"
      "position_error_end,energy_error_max,energy_error_rms,energy_slope,energy_slope_error,momentum_error_max,"
      "angular_momentum_error_max,shadow_fluctuation,truth,truth_error,pareto_time,pareto_evaluations,digest,"
      "orientation_error_max\n"
      "\"a, \"\"quoted\"\" scene.toml\",verlet,0.1,1,,"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 5);
  const std::string json = to_json(c);
  CHECK(json.starts_with("{\"schema\":\"noether.compare/1\""));
  CHECK(json.find('\n') == std::string::npos);
}

TEST_CASE("the report stands alone: one file, nothing from elsewhere", "[compare][files]") {
  const Scene scene = oscillator("method = \"verlet\"\nstep = 0.1\nsteps = 400", 0.1);
  CompareOptions options;
  options.methods = {"verlet", "rk4"};
  options.steps = {0.1, 0.05, 0.025};
  options.repeats = 1;
  Comparison c = compare(scene, options);
  c.title = "A <spring> & more";
  const auto solution = solution_of(scene, c);
  REQUIRE(solution);
  CHECK(std::abs(solution->omega - 1) < 0.1);
  CHECK(solution->dampings.size() == 5);
  CHECK(solution->runs.size() == solution->methods.size() * solution->steps.size() * 5);
  const std::string html = report_html(c, solution);
  for (const char* foreign : {"http://", "https://", "src=", "@import", "url("})
    CHECK(html.find(foreign) == std::string::npos);
  CHECK(html.starts_with("<!DOCTYPE html>"));
  CHECK(html.find("A &lt;spring&gt; &amp; more") != std::string::npos);
  CHECK(html.find("A <spring>") == std::string::npos);
  for (const char* part :
       {"<svg class=\"plot\"", "id=\"solution-data\"", "id=\"damping\"", "Error against run time", "rk4"}) {
    CHECK(html.find(part) != std::string::npos);
  }
}

TEST_CASE("an oscillator without friction is shown with friction too, by methods that take it", "[compare][files]") {
  const Scene scene = oscillator("method = \"verlet\"\nstep = 0.1\nsteps = 400");
  CompareOptions options;
  options.methods = {"verlet", "blanes_moan_srkn14a"};
  options.steps = {0.1};
  options.repeats = 1;
  const Comparison c = compare(scene, options);
  const auto solution = solution_of(scene, c);
  REQUIRE(solution);
  CHECK(solution->own_damping == 0);
  REQUIRE(solution->dampings.size() == 5);
  const double x0 = scene.particles.positions()[0][0], v0 = scene.particles.velocities()[0][0];
  for (std::size_t d = 0; d < 3; ++d) {  // underdamped, with omega = 1
    const double rate = solution->dampings[d] / 2, omega = std::sqrt(1 - rate * rate);
    const ExactMotion& shown = solution->exact[d];
    REQUIRE(shown.q.size() == 321);
    for (std::size_t j = 0; j < shown.q.size(); j += 20) {
      const double t = shown.t[j], exact = x0 * std::cos(omega * t) + (v0 + rate * x0) / omega * std::sin(omega * t);
      CAPTURE(d, t);
      CHECK(std::abs(shown.q[j] - std::exp(-rate * t) * exact) < 1e-13);
    }
  }
  int refused = 0;
  for (const DisplayedRun& run : solution->runs) {
    CHECK(run.t.empty() == run.refused);
    if (!run.refused) continue;
    ++refused;
    CAPTURE(solution->methods[run.method], run.outcome);
    CHECK(run.damping > 0);
    CHECK(run.outcome.find("irreversible") != std::string::npos);
  }
  CHECK(refused > 0);
  const std::string html = report_html(c, solution);
  CHECK(html.find("id=\"damping\" min=\"0\" max=\"4\" value=\"0\"") != std::string::npos);
}

TEST_CASE("the solution of an oscillator of first order is shown too, by dampings", "[compare][files]") {
  const std::string text = R"(units = "reduced"
[system]
type = "forced_damped_oscillator"
omega0 = 2
gamma = 0.1
amplitude = 0.5
omega = 1.5
[integrator]
method = "rk4"
step = 0.05
steps = 400
)";
  const Scene scene = read_scene(text, "driven.toml");
  CompareOptions options;
  options.methods = {"rk4"};
  options.steps = {0.1, 0.05};
  options.repeats = 1;
  const Comparison c = compare(scene, options);
  const auto solution = solution_of(scene, c);
  REQUIRE(solution);
  CHECK(solution->dampings == std::vector<double>{0, 0.05, 0.2, 0.8, 3.2});  // 2 gamma is the rate
  CHECK(solution->coordinate == 'x');
  CHECK(solution->omega > 1.5);
  CHECK(solution->omega < 2);
  CHECK(solution->methods == std::vector<std::string>{"rk4", "euler", "implicit_midpoint", "backward_euler"});
  for (std::size_t d = 0; d < solution->dampings.size(); ++d) {
    const ForcedDampedOscillator exact{.omega0 = 2, .gamma = solution->dampings[d] / 2, .amplitude = 0.5, .omega = 1.5};
    const ExactMotion& shown = solution->exact[d];
    REQUIRE(shown.q.size() == 321);
    for (std::size_t j = 0; j < shown.q.size(); j += 20)
      CHECK(std::abs(shown.q[j] - exact.exact(shown.t[j])[0]) < 1e-13);
  }
  CHECK(solution->runs.size() == 4 * solution->steps.size() * 5);
  CHECK(report_html(c, solution).find("<h2>The solution itself</h2>") != std::string::npos);
  // Two variables alone are no oscillator.
  const Scene ladder = read_scene(R"(units = "reduced"
[system]
type = "rc_ladder"
stages = 2
spread = 10
[integrator]
method = "rk4"
step = 0.01
steps = 400
)",
                                  "ladder.toml");
  options.steps = {0.01};
  CHECK_FALSE(solution_of(ladder, compare(ladder, options)));
}

TEST_CASE("what cannot be compared is refused in words", "[compare]") {
  const Scene scene = oscillator("method = \"verlet\"\nstep = 0.1\nsteps = 400");
  const auto refusal = [&](const CompareOptions& options) {
    try {
      compare(scene, options);
    } catch (const Error& error) {
      return error.message();
    }
    return std::string();
  };
  CHECK(refusal({.methods = {"verlt"}}) == "unknown method 'verlt'; did you mean 'verlet'?");
  CHECK(refusal({.methods = {"verlet@kinetic"}}) == "unknown hamiltonian 'kinetic'; did you mean 'kinetic_potential'?");
  CHECK(refusal({.methods = {"verlet@newtonian"}}) ==
        "unknown hamiltonian 'newtonian'; expected one of: kinetic_potential, wisdom_holman, charged_particles, "
        "k_symplectic, shearing_sheet");
  CHECK(refusal({.methods = {"verlet@wisdom_holman"}}) ==
        "'verlet@wisdom_holman': the scene has no splitting 'wisdom_holman'; leave '@wisdom_holman' out");
  CHECK(refusal({.steps = {-1}}) == "a step of -1 is not valid; a time above 0 is expected");
  CHECK(refusal({.steps = {5}}) ==
        "a step of 5 is longer than the 0.2 between two of the 200 moments at which runs are compared; give shorter "
        "steps, or a longer --until");
  for (const double step : {1e-200, 1e-320, 4.4e-15}) {
    CHECK(refusal({.steps = {0.1, step}}) ==
          fmt::format("a run of 40 has more steps of {} than can be counted; give steps of at least 4.9e-15", step));
  }
  CHECK(refusal({.methods = {"verlet"}, .until = 1e300}) ==
        "a run of 1e+300 has more steps of 0.4 than can be counted; give steps of at least 1.2e+284");
  CHECK(refusal({.tolerances = {2}}) == "2 is not a valid tolerance; a number between 0 and 1 is expected");
  CHECK(refusal({.repeats = 0}) == "0 repeats are too few; 1 or more is expected");
}

TEST_CASE("errors below the rounding of doubles are measured, with their order", "[compare][two words]") {
  const Scene scene = two_planets("method = \"encke_gauss_8\"\nstep = 0.25\nuntil = 50");
  CompareOptions options;
  options.methods = {"encke_gauss_8", "wide_gauss_8", "gauss_8"};
  options.steps = {0.25, 0.125};
  options.tolerances = {1e-15};
  options.repeats = 1;
  const Comparison c = compare(scene, options);
  REQUIRE(c.position_measured);
  CHECK(c.truth.error.value() < 1e-19);
  for (const Row& row : c.rows) {
    INFO(row.who.label << " " << row.setting.step << ": position " << row.position_error_max.value_or(-1) << ", energy "
                       << row.energy_error_max.value_or(-1));
    REQUIRE(row.completed());
    CHECK(row.who.below_rounding == (row.who.method != "gauss_8"));
    if (!row.who.below_rounding) {
      CHECK(row.position_error_max.value() > 1e-17);
      CHECK(row.track.low.empty());
      continue;
    }
    CHECK(row.track.low.size() == row.track.y.size());
    if (row.setting.step > 0.2) continue;
    // Departures of a thousandth are doubles in encke_gauss_8: their rounding, 1e-19, grows along the orbits.
    CHECK(row.position_error_max.value() < (row.who.method == "encke_gauss_8" ? 5e-17 : 1e-19));
    CHECK(row.position_error_max.value() > 1e-24);
    CHECK(row.energy_error_max.value() < 1e-17);
    CHECK(row.energy_error_max.value() > 1e-26);
    CHECK(row.angular_momentum_error_max.value() < 1e-17);
  }
}

}  // namespace

TEST_CASE("orientations are compared with a truth of 113 bits, of one body too", "[study]") {
  const Scene top = read_scene(
      "units = 'reduced'\n[[particles.rigid_body]]\nname = 'top'\nmass = 1\ninertia = [2, 1.5, 1]\n"
      "fixed_point = [0, 0, 0]\ncenter = [0.2, 0.3, 0.5]\nspin = [0.6, -0.4, 0.9]\n"
      "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'uniform_field'\n"
      "acceleration = [0, 0, -1]\n[integrator]\nmethod = 'verlet'\nstep = 0.05\nuntil = 10\n",
      "top.toml");
  CompareOptions options;
  options.methods = {"verlet", "yoshida_4"};
  options.steps = {0.05, 0.025};
  options.repeats = 1;
  const Comparison c = compare(top, options);
  REQUIRE(c.rows.size() == 4);
  REQUIRE(c.truth.kind == TruthKind::quad);
  const auto error = [&](std::size_t k) { return c.rows[k].orientation_error_max.value(); };
  CHECK(std::abs(std::log2(error(0) / error(1)) - 2) < 0.1);
  CHECK(std::abs(std::log2(error(2) / error(3)) - 4) < 0.3);
  for (const Row& row : c.rows) CHECK(row.position_error_max == row.orientation_error_max);  // it stands still
}

TEST_CASE("a free body that is turned wrong has an error, though its centre stands still", "[study]") {
  const Scene free = read_scene(
      "units = 'reduced'\n[[particles.rigid_body]]\nname = 'racket'\nmass = 1\ninertia = [1, 2, 3]\n"
      "angular_velocity = [0.01, 2, 0]\n[hamiltonian]\ntype = 'kinetic_potential'\nrotor = 'axes'\n"
      "[integrator]\nmethod = 'verlet'\nstep = 0.05\nuntil = 10\n",
      "free.toml");
  CompareOptions options;
  options.methods = {"verlet"};
  options.steps = {0.05, 0.025};
  options.repeats = 1;
  const Comparison c = compare(free, options);
  REQUIRE(c.rows.size() == 2);
  for (const Row& row : c.rows) CHECK(row.position_error_max.value() > 1e-5);
  CHECK(std::abs(std::log2(c.rows[0].position_error_max.value() / c.rows[1].position_error_max.value()) - 2) < 0.3);
  CHECK(to_text(c).find("by which the worst body is turned from the truth") != std::string::npos);
}

}  // namespace noether::test

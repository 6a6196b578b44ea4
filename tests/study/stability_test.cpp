// Stability: spectra against closed forms, limits against tables, resonances against the literature.

#include "study/stability.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "scene/json.hpp"
#include "tests/study/scenes.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace noether::test {
namespace {

/// n equal balls on springs between two walls: omega_k = 2 sqrt(k/m) sin(pi k / (2 n + 2)).
Scene chain(int n) {
  std::string text = "units = \"reduced\"\n[particles]\nbody = [\n";
  std::string names;
  for (int i = 0; i < n; ++i) {
    text += fmt::format("{{ name = \"b{}\", mass = 0.5, x = [{}, 0, 0], v = [0.1, 0, 0] }},\n", i, i + 1);
  }
  text += "]\n[hamiltonian]\ntype = \"kinetic_potential\"\n";
  text += fmt::format("[[hamiltonian.force]]\ntype = \"harmonic_bond\"\nchain = [\"b0\", \"b{}\"]\nk = 3\n", n - 1);
  for (const int end : {0, n - 1}) {
    text += fmt::format("[[hamiltonian.force]]\ntype = \"tether\"\nbodies = [\"b{}\"]\nk = 3\npoint = [{}, 0, 0]\n",
                        end, end == 0 ? 0 : n + 1);
  }
  return read_scene(text + "[integrator]\nmethod = \"verlet\"\nstep = 0.1\nsteps = 1000\n", "chain.toml");
}

/// q'' = - q - q^2, q = -y, at rest at q0.
Scene quadratic_well(double q0, double h) {
  return read_scene(fmt::format(R"(units = "reduced"
[particles]
body = [{{ name = "q", mass = 1, x = [0, {}, 0], v = [0, 0, 0] }}]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "henon_heiles"
[integrator]
method = "verlet"
step = {}
steps = 1500
)",
                                -q0, h),
                    "well.toml");
}

/// A ball on a spring of frequency 1 that does not start at an edge of its motion.
Scene ball(const std::string& integrator = "method = \"verlet\"\nstep = 0.1\nsteps = 1000") {
  return read_scene(R"(units = "reduced"
[particles]
body = [{ name = "ball", mass = 1, x = [1, 0, 0], v = [0, 0.5, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "harmonic_field"
k = 1
[integrator]
)" + integrator,
                    "ball.toml");
}

StabilityRow row_of(const Scene& scene, const std::string& method, double budget = 300,
                    std::int64_t confirm_steps = 100'000) {
  StabilityOptions options;
  options.methods = {method};
  options.confirm_steps = confirm_steps;
  options.row_budget = budget;
  return find_stability(scene, options).rows.at(0);
}

TEST_CASE("spectra of chains are those of the closed form, dense and by Lanczos", "[stability]") {
  for (const int n : {2, 7, 100}) {
    const Scene scene = chain(n);
    CAPTURE(n);
    const double expected = 2 * std::sqrt(6.0) * std::sin(M_PI * n / (2 * n + 2));
    const Spectrum found = spectrum_at(scene, scene.particles);
    CHECK(found.converged);
    CHECK(std::abs(found.fastest / expected - 1) < 1e-8);
    CHECK(found.steepest == 0);
    CHECK(is_linear(scene));
    if (n == 100) CHECK(found.products <= 200);
  }
}

TEST_CASE("Lanczos finds both ends of a spectrum, and of a small one exactly", "[stability]") {
  const auto diagonal = [](const Vector<double>& in, Vector<double>& out) {
    out.resize(in.size());
    for (Index i = 0; i < in.size(); ++i) out[i] = (static_cast<double>(i) - 40) * in[i];
  };
  const Extremes ends = lanczos(diagonal, 300);
  CHECK(ends.converged);
  CHECK(std::abs(ends.least + 40) < 1e-6);
  CHECK(std::abs(ends.largest - 259) < 1e-6);
  const Extremes few = lanczos(diagonal, 3);
  CHECK(std::abs(few.least + 40) < 1e-12);
  CHECK(std::abs(few.largest + 38) < 1e-12);
}

TEST_CASE("the spectrum of a circular orbit has the orbit's frequency and the tide's rate", "[stability]") {
  const Scene scene = kepler(0, "method = \"verlet\"\nstep = 0.01\nsteps = 1000");
  const Spectrum found = spectrum_along(scene);
  CHECK(std::abs(found.fastest - 1) < 1e-6);
  CHECK(std::abs(found.steepest - std::sqrt(2.0)) < 1e-6);
  CHECK_FALSE(is_linear(scene));
}

TEST_CASE("linear theory has the tabulated limits and the closed resonances", "[stability]") {
  const Scene scene = ball();
  const Mode mode{.omega = 1, .rate = 0, .lambda = {}};
  const auto theory = [&](const std::string& name) { return linear_theory(scene, fixed_candidate(scene, name), mode); };
  for (const Scheme* scheme : schemes::all()) {
    if (scheme->stability_limit == 0) continue;
    CAPTURE(std::string(scheme->name));
    const LinearTheory found = theory(std::string(scheme->name));
    REQUIRE(found.limit);
    CHECK(std::abs(*found.limit - scheme->stability_limit) < 1e-4);
  }
  for (const char* name : {"rk4", "dormand_prince_5", "dop853"}) {
    CAPTURE(name);
    CHECK(std::abs(*theory(name).limit - methods::find(name)->stability_limit) < 1e-3);
  }
  for (const char* name : {"trapezoidal", "backward_euler", "sdirk_4", "implicit_midpoint", "gauss_8"}) {
    CAPTURE(name);
    CHECK_FALSE(theory(name).limit);
    CHECK_FALSE(theory(name).solver);
  }
  const LinearTheory verlet = theory("verlet"), srkn = theory("srkn11b");
  for (int n = 3; n <= 6; ++n) CHECK(std::abs(verlet.resonances.at(n) - 2 * std::sin(M_PI / n)) < 1e-8);
  CHECK(verlet.resonance_at(1.74) == 3);
  CHECK(verlet.resonance_at(0.3) == 0);
  CHECK(std::abs(srkn.gap_end.value() - 3.14232) < 1e-5);
  const LinearTheory rule = theory("trapezoidal");  // as of the midpoint rule
  for (int n = 3; n <= 6; ++n) CHECK(std::abs(rule.resonances.at(n) - 2 * std::tan(M_PI / n)) < 1e-7);
  CHECK(std::abs(verlet.accurate / (M_PI / 10) - 1) < 0.02);  // 20 steps a period
}

TEST_CASE("theory of multistep methods is that of their characteristic roots", "[stability]") {
  const Scene scene = ball();
  const auto theory = [&](const std::string& name, const Mode& mode) {
    return linear_theory(scene, fixed_candidate(scene, name), mode);
  };
  const Mode undamped{.omega = 1, .rate = 0, .lambda = {}};
  for (const char* name : {"adams_bashforth_3", "adams_bashforth_4", "adams_moulton_5", "adams_moulton_6", "bdf_5",
                           "stormer_cowell_12", "stormer_cowell_13", "stormer_cowell_14"}) {
    CAPTURE(name);
    CHECK(std::abs(*theory(name, undamped).limit - methods::find(name)->stability_limit) < 1e-4);
  }
  CHECK(theory("bdf_2", undamped).known);
  CHECK_FALSE(theory("bdf_2", undamped).limit);
  // Roots of sum (1 - 1/x)^j / j = i z in 40 digits, where they grow by 1e-9, and where they no longer do.
  struct Gap {
    const char* name;
    double limit, end;
  };
  for (const auto& [name, limit, end] :
       {Gap{"bdf_3", 0.0079528121, std::sqrt(15.0) / 2}, Gap{"bdf_4", 0.03798264, 10 * std::sqrt(2.0) / 3},
        Gap{"bdf_5", 0.71080768, 9.3920195}}) {
    CAPTURE(name);
    const LinearTheory found = theory(name, undamped);
    CHECK(std::abs(*found.limit - limit) < 1e-6);
    CHECK(std::abs(*found.gap_end - end) < 1e-6);
  }
  // Fixed points are no longer found: 2 eps^(1/200) for the trapezoidal rule.
  CHECK(std::abs(*theory("adams_moulton_2", undamped).solver - 2 * std::exp(-36.0436533891171561 / 200)) < 1e-12);
  // A decay: explicit Euler to z = 2, Adams-Bashforth 2 to z = 1; backward differences at any step.
  const Mode decay{.omega = 0, .rate = 0, .lambda = std::complex<double>(-3, 0)};
  CHECK(std::abs(*theory("adams_bashforth_1", decay).limit - 2) < 1e-6);
  CHECK(std::abs(*theory("adams_bashforth_2", decay).limit - 1) < 1e-6);
  CHECK_FALSE(theory("bdf_4", decay).limit);
  // With friction of twice the critical: rates (2 +- sqrt 3) omega, the faster one decides.
  const Mode creeping{.omega = 1, .rate = 4, .lambda = {}};
  CHECK(std::abs(*theory("adams_bashforth_2", creeping).limit - 1 / (2 + std::sqrt(3.0))) < 1e-6);
  CHECK(theory("adams_bashforth_4", undamped).accurate > 0.05);
}

TEST_CASE("a real rate of a Lagrangian system is one of critical damping, or of a saddle", "[stability]") {
  const auto theory = [](const std::string& method, const std::string& damping, std::complex<double> lambda) {
    const Scene scene = read_scene("units = 'reduced'\n[system]\ntype = 'pendulum'\ndamping = " + damping +
                                       "\n[integrator]\nmethod = 'variational_midpoint'\nstep = 0.1\nsteps = 100\n",
                                   "pendulum.toml");
    return linear_theory(scene, fixed_candidate(scene, method), {.omega = 0, .rate = 0, .lambda = lambda});
  };
  // (1 + z) r^2 - (2 - z^2) r + 1 - z = 0 has a root of -1 at z = 2.
  CHECK(std::abs(theory("variational_trapezoidal", "5", -3.0).limit.value() - 2) < 1e-6);
  CHECK(theory("variational_midpoint", "5", -3.0).known);
  CHECK_FALSE(theory("variational_midpoint", "5", -3.0).limit);
  CHECK_FALSE(theory("variational_midpoint", "0", -3.0).known);
  CHECK_FALSE(theory("variational_midpoint", "5", 3.0).known);
  CHECK(std::abs(theory("variational_trapezoidal", "0", {0, 3}).limit.value() - 2) < 1e-4);
}

TEST_CASE("methods over an energy have the theory of their own mode", "[stability]") {
  const auto scene_by = [](const std::string& method) {
    return read_scene(
        "units = 'reduced'\n[system]\ntype = 'nonseparable_oscillator'\nposition = 1e-4\n[integrator]\n"
        "method = '" +
            method + "'\nstep = 0.1\nsteps = 100\n",
        "oscillator.toml");
  };
  const auto theory = [&](const std::string& method, std::complex<double> lambda) {
    const Scene scene = scene_by(method);
    return linear_theory(scene, fixed_candidate(scene, method), {.omega = 0, .rate = 0, .lambda = lambda});
  };
  for (const char* method : {"gonzalez", "avf", "hbvm_4_2", "semiexplicit_2"}) {
    CAPTURE(method);
    CHECK(theory(method, {0, 3}).known);
    CHECK_FALSE(theory(method, {0, 3}).limit);
  }
  CHECK_FALSE(theory("semiexplicit_2", {0.5, 3}).known);
  CHECK_FALSE(theory("tao_2", {0, 3}).known);
}

TEST_CASE("measured limits are within 1e-3 of the tabulated ones", "[stability][nightly]") {
  const Scene scene = ball();
  for (const char* name : {"verlet", "yoshida_4", "rk4", "dormand_prince_5", "adams_bashforth_3"}) {
    const Scheme* scheme = schemes::find(name);
    const double table = scheme != nullptr ? scheme->stability_limit : methods::find(name)->stability_limit;
    const StabilityRow row = row_of(scene, name);
    CAPTURE(name, row.message, table);
    CHECK(row.settled);
    CHECK(row.reason == "linear");
    CHECK(std::abs(row.limit_h_omega.value() - table) < 1e-3);
    CHECK(row.recommended_step.value() <= row.limit_h_omega.value() / 2);  // omega = 1
  }
}

TEST_CASE("gaps narrower than the search are found, with their ends", "[stability][slow]") {
  const StabilityRow row = row_of(ball(), "srkn11b");
  CHECK(std::abs(row.limit_h_omega.value() - 3.14143) < 1e-3);
  CHECK(std::abs(row.gap_end.value() - 3.14232) < 1e-4);
}

TEST_CASE("a method that is stable at any step has no limit, and one that cannot solve its steps says so",
          "[stability][nightly]") {
  for (const char* name : {"trapezoidal", "implicit_midpoint", "gauss_4"}) {
    // The fewest steps in which growth by 1e-9 in one of them is told.
    const StabilityRow stable = row_of(ball(), name, 3000, 50'000);
    CAPTURE(name, stable.message);
    CHECK(stable.reason == "none");
    CHECK_FALSE(stable.limit_step);
    CHECK(stable.steps < 24'000'000);  // about 230 long runs, not one every 0.05 up to 200
  }
  const StabilityRow swept = row_of(ball(), "adams_moulton_2", 3000);
  INFO(swept.message);
  CHECK(swept.reason == "solver");
  CHECK(swept.limit_h_omega.value() <= 2);
}

TEST_CASE("the largest bounded start of q'' = -q - q^2 under leapfrog is that of the literature", "[stability]") {
  // Table of the survey, rows 1.70 to 1.90, to 0.002; 1500 steps.
  for (const auto& [h, largest] : {std::pair(1.70, 0.088), std::pair(1.72, 0.028), std::pair(std::sqrt(3.0), 0.0),
                                   std::pair(1.74, 0.009), std::pair(1.78, 0.047), std::pair(1.9, 0.127)}) {
    const auto bounded = [&, step = h](double q0) {
      const Scene scene = quadratic_well(q0, step);
      return try_step(scene, candidate(scene, "verlet"), step, 1500, {}, 10).stable();
    };
    CAPTURE(h, largest);
    if (largest > 0.002) CHECK(bounded(largest - 0.002));
    CHECK_FALSE(bounded(largest + 0.002));
  }
}

TEST_CASE("below the linear limit a nonlinear problem fails at its resonance", "[stability][slow]") {
  const StabilityRow row = row_of(quadratic_well(0.05, 0.1), "verlet");
  INFO(row.message);
  CHECK(row.reason == "resonance");
  CHECK(row.resonance == 3);
  CHECK(std::abs(row.limit_step.value() - 1.715) < 0.02);
}

TEST_CASE("a search whose budget is over says so", "[stability]") {
  const StabilityRow row = row_of(ball(), "dop853", 0.05);
  CHECK_FALSE(row.settled);
  CHECK(row.message.find("budget") != std::string::npos);
  CHECK_FALSE(row.limit_step);
  CHECK(row.bounded_until);
  CHECK(row.seconds < 2);
}

TEST_CASE("a limit that is not settled is no missing limit: the bound below it is told", "[stability]") {
  for (const bool oscillates : {true, false}) {
    const Scene scene = oscillates ? ball() : load_scene(NOETHER_SOURCE_DIR "/examples/pendulum/scene.toml");
    StabilityOptions options;
    options.methods = {"verlet"};
    options.row_budget = 0.1;
    const Stability found = find_stability(scene, options);
    const StabilityRow& row = found.rows.at(0);
    INFO(to_text(found));
    REQUIRE_FALSE(row.settled);
    CHECK(row.reason == "not_settled");
    REQUIRE(row.bounded_step);
    CHECK(row.bounded_until.has_value() == oscillates);
    if (oscillates) CHECK(*row.bounded_step == *row.bounded_until / found.mode.scale());
    CHECK(to_json(found).find("\"limit_step\":null") != std::string::npos);
    CHECK(to_json(found).find("\"reason\":\"not_settled\"") != std::string::npos);
    CHECK(to_json(found).find("\"bounded_step\":" + Json(*row.bounded_step).text()) != std::string::npos);
    const std::string text = to_text(found), bound = fmt::format("> {:.6g} ", *row.bounded_step);
    CHECK(text.find(bound) != std::string::npos);
    CHECK(text.find(" not settled ") != std::string::npos);
    CHECK(text.find("none, not settled") == std::string::npos);
    CHECK((row.message.find("h omega") != std::string::npos) == oscillates);
    CHECK(to_html(found).find(fmt::format("<td>&gt; {:.5g}</td>", *row.bounded_step)) != std::string::npos);
    CHECK(to_html(found).find("<td>not settled</td>") != std::string::npos);
  }
}

/// What moves freely in a field of constant acceleration g along -y.
Scene falling(const std::string& bodies, const std::string& forces, double g, double step) {
  return read_scene(fmt::format(R"(units = "reduced"
[particles]
body = [{}]
[hamiltonian]
type = "kinetic_potential"
{}
[[hamiltonian.force]]
type = "uniform_field"
acceleration = [0, {}, 0]
[integrator]
method = "verlet"
step = {}
steps = 1000
)",
                                bodies, forces, -g, step),
                    "falling.toml");
}

TEST_CASE("a ball that falls is no fault of a step: the solution itself leaves, and the report says so",
          "[stability]") {
  const Scene scene = falling(R"({ name = "ball", mass = 1, x = [0, 0, 0], v = [1, 0, 0] })", "", 1, 0.1);
  StabilityOptions options;
  options.methods = {"verlet", "rk4", "implicit_midpoint"};
  const Stability found = find_stability(scene, options);
  INFO(to_text(found));
  // Positions weigh twice as much as velocities: A^2 = 1 + t^2 + 4 (t^2 + t^4 / 4) is 10^4 at t = 9.8755.
  REQUIRE(found.solution_leaves);
  CHECK(*found.solution_leaves >= 9.8755);
  CHECK(*found.solution_leaves < 9.92);
  for (const StabilityRow& row : found.rows) {
    CAPTURE(row.who.label);
    CHECK(row.reason == "none");
    CHECK(row.settled);
    CHECK_FALSE(row.limit_step);
  }
  // When it was seen depends on how far the first run came in its time.
  const std::string said =
      fmt::format("the solution itself is 100 times as large as at the start after {:.5g}:", *found.solution_leaves);
  CHECK(to_text(found).find("\n" + said) != std::string::npos);
  CHECK(to_html(found).find(">" + said) != std::string::npos);
  CHECK(to_json(found).find("\"solution_leaves\":" + Json(*found.solution_leaves).text()) != std::string::npos);
}

TEST_CASE("a pair on a spring that falls has the limit of the spring", "[stability][slow]") {
  const Scene scene = falling(R"({ name = "a", mass = 1, x = [0, 0, 0], v = [0, 0, 0] },
{ name = "b", mass = 1, x = [0.1, 0, 0], v = [0, 0, 0] })",
                              R"([[hamiltonian.force]]
type = "harmonic_bond"
pairs = [["a", "b"]]
k = 50)",
                              1e-3, 0.01);
  StabilityOptions options;
  options.methods = {"verlet"};
  options.row_budget = 100;
  const Stability found = find_stability(scene, options);
  INFO(to_text(found));
  REQUIRE(found.solution_leaves);  // A = 1 at the start, omega = 10: 10 sqrt(2) g t^2 / 2 is 100 at t = 118.9
  CHECK(std::abs(*found.solution_leaves - 118.9) < 0.5);
  const StabilityRow& row = found.rows.at(0);
  CHECK(row.settled);
  CHECK(row.reason == "linear");
  CHECK(std::abs(row.limit_h_omega.value() - 2) < 1e-3);
}

TEST_CASE("what stays has no time at which the solution leaves", "[stability]") {
  StabilityOptions options;
  options.methods = {"euler"};
  options.row_budget = 1;
  const Stability found = find_stability(ball(), options);
  CHECK_FALSE(found.solution_leaves);
  CHECK(growth_lines(found).empty());
  CHECK(to_json(found).find("\"solution_leaves\":null") != std::string::npos);
}

TEST_CASE("drag moves limits as the theory of its letter says", "[stability][slow]") {
  const Scene scene = oscillator("method = \"euler\"\nstep = 0.1\nsteps = 1000", 0.2);
  const StabilityRow row = row_of(scene, "euler");
  CHECK(std::abs(row.limit_h_omega.value() - 0.2) < 1e-3);  // h < 2 gamma / omega^2, gamma = rate / 2
  CHECK(std::abs(row.theory.limit.value() - 0.2) < 1e-6);
}

TEST_CASE("first-order systems have the limits of their eigenvalues", "[stability][nightly]") {
  // The explicit Euler method needs h |lambda| < 2 on the real axis, RK4 2.78529.
  const Scene scene = read_scene(R"(units = "reduced"
[system]
type = "heat_line"
points = 8
mode = 1
[integrator]
method = "rk4"
step = 1e-4
steps = 2000
)",
                                 "heat.toml");
  const StabilityRow euler = row_of(scene, "euler"), rk4 = row_of(scene, "rk4");
  INFO(euler.message << rk4.message);
  CHECK(std::abs(euler.theory.limit.value() - 2) < 1e-6);
  CHECK(std::abs(rk4.theory.limit.value() - 2.78529) < 1e-4);
  CHECK(std::abs(euler.limit_h_omega.value() - 2) < 1e-3);
  CHECK(std::abs(rk4.limit_h_omega.value() - 2.78529) < 1e-3);
}

/// A star with a planet on a circle of radius 1 and a comet, both massless, at their pericenters.
Scene planet_and_comet(double comet_a, double comet_e) {
  return read_scene(fmt::format(R"(units = "reduced"
[particles]
body = [
{{ name = "star", mass = 0.5, x = [0, 0, 0], v = [0, 0, 0] }},
{{ name = "planet", mass = 0, a = 1, e = 0 }},
{{ name = "comet", mass = 0, a = {}, e = {} }},
]
[hamiltonian]
type = "wisdom_holman"
G = 2
[integrator]
method = "verlet"
step = 0.1
steps = 1000
)",
                                comet_a, comet_e),
                    "comet.toml");
}

TEST_CASE("steps along Kepler arcs resonate with periods of Kepler's third law", "[stability][kepler]") {
  // G M = 1: the period of a = 1 is 2 pi, that of a = 1/4 an eighth of it.
  const auto shortest = [](double a, double e) { return kepler_steps(planet_and_comet(a, e)).value(); };
  const KeplerSteps outside = shortest(4, 0.5), inside = shortest(0.25, 0.5), passing = shortest(-1, 1.5);
  CHECK(std::abs(outside.period / (2 * M_PI) - 1) < 1e-14);
  CHECK(outside.period_of == "planet");
  CHECK(std::abs(inside.period / (M_PI / 4) - 1) < 1e-14);
  CHECK(inside.period_of == "comet");
  CHECK(passing.period_of == "planet");
  for (const int n : {1, 3, 5}) {
    CAPTURE(n);
    Scene scene = planet_and_comet(0.25, 0.5);
    Simulation<double> sim = assemble(variant(scene, candidate(scene, "verlet"), {inside.resonance(n), 0}));
    REQUIRE(sim.run(n).ok());
    const Vec3<double> moved = sim.particles().positions()[2] - scene.particles.positions()[2];
    CHECK(std::sqrt(norm2(moved)) < 1e-13);
  }
}

TEST_CASE("the fastest passage of a pericenter is a turn at the angular speed there", "[stability][kepler]") {
  for (const auto& [a, e] : {std::pair(4.0, 0.9), std::pair(100.0, 0.99), std::pair(-1.0, 1.2)}) {
    CAPTURE(a, e);
    const Scene scene = planet_and_comet(a, e);
    const Vec3<double> x = scene.particles.positions()[2], v = scene.particles.velocities()[2];
    const double turning = std::sqrt(norm2(cross(x, v))) / norm2(x);
    const KeplerSteps found = kepler_steps(scene).value();
    CHECK(found.passage_of == "comet");
    CHECK(found.period_of == "planet");
    CHECK(std::abs(found.passage * turning / (2 * M_PI) - 1) < 1e-12);
    CHECK(std::abs(found.longest() / found.recommended() - 1.25) < 1e-14);
  }
  CHECK(kepler_steps(planet_and_comet(4, 0.1)).value().passage_of == "planet");
  CHECK_FALSE(kepler_steps(ball()));
}

TEST_CASE("moons count among the fastest passages, wherever they are bound", "[stability][kepler]") {
  // A moon 0.00242848670439 au from the Earth at 0.000625152665503885 au/day, in its pericenter.
  const auto scene = [](const std::string& speed) {
    return read_scene(
        "units = 'solar'\n[[particles.body]]\nname = 'Sun'\nmass = '1 Msun'\n[[particles.body]]\nname = 'Earth'\nmass "
        "= "
        "'3.0034896e-06 Msun'\nx = ['1 au', '0 au', '0 au']\nv = ['0 au/day', '0.017202125100865537 au/day', '0 "
        "au/day']\n[[particles.body]]\nname = 'Moon'\nmass = '3.694e-08 Msun'\nx = ['1.00242848670439 au', '0 au', '0 "
        "au']\nv = ['0 au/day', '" +
            speed +
            " au/day', '0 au/day']\n[hamiltonian]\ntype = 'wisdom_holman'\n[integrator]\nmethod = 'aba_10_6_4'\nstep = "
            "'1 day'\nsteps = 10\n",
        "moon.toml");
  };
  const KeplerSteps found = kepler_steps(scene("0.017827278646340743")).value();
  CHECK(found.passage_of == "Moon about Earth");
  CHECK(found.period_of != "Moon about Earth");
  const double turning = (0.017827278646340743 - 0.017202125100865537) / 0.00242848670439;
  CHECK(std::abs(found.passage * turning / (2 * M_PI) - 1) < 1e-11);
  CHECK(std::abs(found.recommended() - 1.22) < 0.01);
  // One that is not bound is no moon: at a relative speed of 0.01 au/day it flies past.
  CHECK(kepler_steps(scene("0.0272")).value().passage_of != "Moon about Earth");
}

/// How far the Jacobi constant of a massless comet on an orbit of e = 0.9, inside that of a giant on a circle, has come
/// off over 4000 units of time: relative, on the mean of the last quarter.
double jacobi_constant_lost(double steps_in_a_passage) {
  const Scene scene = read_scene(R"(units = "reduced"
[particles]
frame = "barycenter"
body = [
{ name = "star", mass = 1, x = [0, 0, 0], v = [0, 0, 0] },
{ name = "giant", mass = 1e-3, a = 5, e = 0 },
{ name = "comet", mass = 0, a = 1, e = 0.9, M = 1 },
]
[hamiltonian]
type = "wisdom_holman"
coordinates = "democratic"
[integrator]
method = "verlet"
step = 0.1
steps = 1000
)",
                                 "comet.toml");
  const double h = kepler_steps(scene).value().passage / steps_in_a_passage, n = std::sqrt(1.001 / 125);
  Simulation<double> sim = assemble(variant(scene, candidate(scene, "verlet"), {h, 0}));
  const auto constant = [&] {
    const auto& s = sim.particles();
    const Vec3<double> x = s.positions()[2], v = s.velocities()[2];
    const auto distance = [&](Index i) { return std::sqrt(norm2(Vec3<double>(x - s.positions()[i]))); };
    return norm2(v) / 2 - 1 / distance(0) - 1e-3 / distance(1) - n * (x[0] * v[1] - x[1] * v[0]);
  };
  const double before = constant();
  constexpr int looks = 400;
  double sum = 0;
  for (int k = 0; k < looks; ++k) {
    REQUIRE(sim.run(static_cast<std::int64_t>(4000 / h / looks)).ok());
    if (k >= 3 * looks / 4) sum += constant() / before - 1;
  }
  return std::abs(sum / (looks / 4));
}

TEST_CASE("steps by the rule keep the Jacobi constant of a comet, those that miss its pericenter lose it",
          "[stability][kepler]") {
  const double by_rule = jacobi_constant_lost(16), missing = jacobi_constant_lost(1.5);
  CAPTURE(by_rule, missing);
  CHECK(by_rule < 1e-5);
  CHECK(missing > 1e-3);
}

TEST_CASE("a search along Kepler arcs tells resonances and the rule of the pericenter, others do not",
          "[stability][kepler]") {
  const Scene scene = planet_and_comet(4, 0.9);
  StabilityOptions options;
  options.methods = {"verlet"};
  options.row_budget = 0.2;
  const Stability arcs = find_stability(scene, options);
  REQUIRE(arcs.kepler);
  const StabilityRow& row = arcs.rows.at(0);
  CHECK_FALSE(row.theory.known);
  REQUIRE(row.theory.resonances.size() == 6);
  for (const auto& [n, z] : row.theory.resonances) {
    CHECK(std::abs(z / arcs.mode.scale() * n / (2 * M_PI) - 1) < 1e-13);
  }
  CHECK(row.recommended_step.value() <= arcs.kepler->recommended() * (1 + 1e-15));
  CHECK(to_text(arcs).find("at steps of 6.2832, 3.1416, 2.0944, 1.5708, 1.2566, 1.0472\n") != std::string::npos);
  CHECK(to_text(arcs).find("\nrule, no limit: 16 steps in the fastest passage of a pericenter, ") != std::string::npos);
  CHECK(to_html(arcs).find("rule, no limit: ") != std::string::npos);
  CHECK(to_json(arcs).find("\"kepler\":{\"shortest_period\":6.28318") != std::string::npos);
  options.methods = {"verlet@kinetic_potential"};
  const Stability whole = find_stability(scene, options);
  CHECK_FALSE(whole.kepler);
  CHECK(kepler_lines(whole).empty());
  CHECK(to_json(whole).find("\"kepler\":null") != std::string::npos);
}

TEST_CASE("what cannot be asked is refused", "[stability]") {
  const Scene scene = ball();
  CHECK_THROWS_WITH(row_of(scene, "bdf"),
                    "method 'bdf' chooses its steps by a tolerance, so it has no largest step; give one of fixed "
                    "steps, such as 'rk4'");
  CHECK_THROWS_WITH(row_of(scene, "verlt"), "unknown method 'verlt'; did you mean 'verlet'?");
  CHECK_THROWS_WITH(row_of(scene, "verlet", 0), "a budget of 0 s is not valid; a number above 0 is expected");
}

}  // namespace
}  // namespace noether::test

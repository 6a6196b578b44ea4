// The report of a run: reasons, notes, figures that are no numbers.

#include <fmt/format.h>
#include "scene/run.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"
#include "tests/support/json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

namespace noether::test {
namespace {

RunReport report_with(const std::string& name, const MonitorReport& monitor) {
  RunReport report;
  report.monitors.emplace_back(name, monitor);
  return report;
}

TEST_CASE("a note is no message of the run, a reason is", "[scene][report]") {
  MonitorReport monitor;
  monitor.samples = 3;
  monitor.note = "six numbers for each particle";
  const RunReport noted = report_with("elements", monitor);
  CHECK(json_member(to_json(noted), "message") == "\"\"");
  CHECK(has(to_json(noted), R"("note":"six numbers for each particle")"));
  CHECK_FALSE(has(to_json(noted), "\"reason\""));
  CHECK(has(to_text(noted), "elements: six numbers for each particle (3 samples)\n"));

  monitor.reason = "the run is dissipative";
  const RunReport reasoned = report_with("energy", monitor);
  CHECK(json_member(to_json(reasoned), "message") == "\"energy: the run is dissipative\"");
  CHECK(has(to_json(reasoned), R"("reason":"the run is dissipative","note":"six)"));
  CHECK(has(to_text(reasoned), "energy: the run is dissipative; six numbers for each particle (3 samples)\n"));
}

TEST_CASE("the epoch of bodies from Horizons stands in the report, where there is one", "[scene][report]") {
  RunReport report;
  CHECK_FALSE(has(to_json(report), "epoch"));
  CHECK_FALSE(has(to_text(report), "bodies"));
  report.epoch = "JD 2451545 TDB";
  CHECK(json_member(to_json(report), "epoch") == "\"JD 2451545 TDB\"");
  CHECK(has(to_text(report), "bodies: as of JD 2451545 TDB\n"));
}

TEST_CASE("a drift stands in JSON as a number with its error and unit, where there is one", "[scene][report]") {
  MonitorReport monitor;
  monitor.samples = 3;
  CHECK_FALSE(has(to_json(report_with("energy", monitor)), "drift"));
  monitor.drift = -0.125;
  monitor.drift_unit = "kT/ns/atom";
  CHECK(has(to_json(report_with("energy", monitor)),
            R"("samples":3,"drift":-0.125,"drift_error":null,"drift_unit":"kT/ns/atom"})"));
  monitor.drift_error = 0.5;
  CHECK(has(to_json(report_with("energy", monitor)), R"("drift":-0.125,"drift_error":0.5,"drift_unit":"kT/ns/atom")"));
}

TEST_CASE("a monitor that saw nothing finite says so", "[scene][report]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  MonitorReport monitor;
  monitor.samples = 2;
  CHECK(has(to_text(report_with("energy", monitor)), "energy: watched (2 samples)\n"));
  monitor.first = monitor.last = monitor.worst = monitor.rms = nan;
  CHECK(has(to_text(report_with("energy", monitor)), "energy: no finite value was recorded (2 samples)\n"));
  monitor.worst = 0.5;
  CHECK(has(to_text(report_with("energy", monitor)), "energy: worst 0.5 (2 samples)\n"));
}

/// What a run of eight steps says of its constraints.
struct OfConstraints {
  std::string line;
  double iterations = 0, contraction = 0;  ///< as JSON has them; 0 for null
};
OfConstraints of_constraints(const std::string& particles, const std::string& constraints) {
  const ScratchFolder folder;
  const std::string text = "units = 'molecular'\n[particles]\ntemperature = '300 K'\n" + particles +
                           "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.constraint]]\n" + constraints +
                           "[integrator]\nmethod = 'verlet'\nstep = '2 fs'\nsteps = 8\n";
  const RunReport report =
      run(read_scene(text, folder.path() / "scene.toml"), {.out = folder.path() / "out", .existing = Existing::fresh});
  REQUIRE(report.outcome.ok());
  const std::string words = to_text(report), json = to_json(report);
  const std::size_t begin = words.find("constraints: "), object = json.find("\"constraints\":{");
  REQUIRE(begin != words.npos);
  REQUIRE(object != json.npos);
  const auto number = [&](const std::string& key) {
    return std::atof(json.c_str() + json.find("\"" + key + "\":", object) + key.size() + 3);
  };
  OfConstraints found{words.substr(begin, words.find('\n', begin) - begin), number("iterations"),
                      number("contraction")};
  if (found.contraction > 0)
    CHECK(has(found.line, fmt::format("; one leaves {:.2g} of the violation", found.contraction)));
  return found;
}
/// Rigid bonds of 64 decanes.
OfConstraints of_decane(const std::string& solver) {
  return of_constraints("structure = '" NOETHER_SOURCE_DIR "/examples/decane/decane.data'\nfile_units = 'real'\n",
                        "type = 'bonds'\nsolver = " + solver + "\n");
}
/// 27 rigid waters.
OfConstraints of_water(const std::string& solver) {
  return of_constraints("type = 'water_box'\nmolecules = 27\ndensity = '0.997 g/cm^3'\n",
                        "type = 'rigid_molecules'\nsolver = " + solver + "\n");
}

TEST_CASE("the report tells what an iteration leaves of violations: sweeps what their number for tolerances says",
          "[scene][report]") {
  double of_rattle = 0;
  for (const std::string solver : {"'rattle'", "'p_shake'"}) {
    const OfConstraints loose = of_decane(solver + "\ntolerance = 1e-4"),
                        tight = of_decane(solver + "\ntolerance = 1e-12");
    // Of a step the stage of positions and that of velocities after it: after kicks, which are none, nothing is left.
    const double more = (tight.iterations - loose.iterations) / (2 * 8), expected = std::pow(1e-8, 1 / more);
    CAPTURE(tight.line, loose.line, expected);
    CHECK(std::abs(std::log(tight.contraction) / std::log(expected) - 1) < 0.2);
    if (solver == "'rattle'")
      of_rattle = tight.contraction;
    else
      CHECK(tight.contraction < of_rattle * of_rattle);
  }
  CHECK(of_rattle > 0.14);  // C16; of the slowest of 64 molecules it is a little more than of six
  CHECK(of_rattle < 0.26);
}

TEST_CASE("the report tells what steps of Newton's methods and powers of series leave, and what is solved directly",
          "[scene][report]") {
  const OfConstraints newton = of_decane("'newton'"), dense = of_decane("'m_shake'"), triangles = of_water("'newton'");
  CHECK(newton.contraction > 1e-4);
  CHECK(newton.contraction < 0.05);  // chord steps of 2 fs
  CHECK(dense.contraction > 0);
  CHECK(dense.contraction < 1e-2 * newton.contraction);  // those with a matrix of the moment
  CHECK(triangles.contraction > 0);
  CHECK(triangles.contraction < 0.01);
  const OfConstraints alone = of_decane("'lincs'"), together = of_decane("'p_lincs'");
  CHECK(alone.line.starts_with("constraints: 128 powers of the series in all, 16 for each force evaluation; one "));
  CHECK(together.iterations == 128);  // 16 a step: two times four for positions, two times four for velocities
  CHECK(alone.contraction > 0.3);
  CHECK(alone.contraction < 0.7);
  CHECK(std::abs(together.contraction / alone.contraction - 1) < 0.05);  // of all bonds, and of 64
  const OfConstraints direct = of_water("'settle'");
  CHECK(direct.line == "constraints: solved directly by settle");
  CHECK(direct.iterations == 0);
  CHECK(direct.contraction == 0);
}

TEST_CASE("where the closed form has no solution the report has the iterations of what goes on", "[scene][report]") {
  RunReport report;
  CHECK_FALSE(has(to_text(report), "constraints"));
  CHECK_FALSE(has(to_json(report), "\"constraints\""));
  report.solver = ConstraintMethod::settle;
  report.evaluations.force = 2;
  report.evaluations.constraint = {.iterations = 3, .measured = 2, .log = 2 * std::log(0.25)};
  CHECK(has(to_text(report),
            "constraints: solved directly by settle; beyond it, 3 iterations in all, 1.5 for each force "
            "evaluation; one leaves 0.25 of the violation\n"));
  CHECK(has(to_json(report), R"("constraints":{"solver":"settle","direct":true,"iterations":3,"contraction":0.25})"));
}

TEST_CASE("slopes of the reduced system have the unit 1", "[scene][report]") {
  const std::string text = R"(units = "reduced"
[[particles.body]]
name = "Sun"
mass = 1
[[particles.body]]
name = "Planet"
mass = 0.001
x = [1, 0, 0]
v = [0, 1, 0]
[hamiltonian]
type = "wisdom_holman"
[integrator]
method = "verlet_aba"
step = 0.01
steps = 100
[[every]]
type = "energy"
steps = 10
[[every]]
type = "center_of_mass"
steps = 10
)";
  const auto units_of = [&](const Scene& scene) {
    Simulation<double> sim = assemble(scene);
    CHECK(sim.run(100).ok());
    std::string units;
    sim.for_each_monitor([&](const std::string&, AnyMonitor<double>& one) { units += one.report()->slope_unit + " "; });
    return units;
  };
  CHECK(units_of(read_scene(text, "scene.toml")) == "1 1 ");
  std::string solar = text;
  for (const auto& [from, to] : {std::pair{"\"reduced\"", "\"solar\""},
                                 {"mass = 1\n", "mass = \"1 Msun\"\n"},
                                 {"mass = 0.001", "mass = \"1 kg\""},
                                 {"[1, 0, 0]", "[\"1 au\", \"0 au\", \"0 au\"]"},
                                 {"[0, 1, 0]", "[\"0 km/s\", \"30 km/s\", \"0 km/s\"]"},
                                 {"0.01", "\"1 day\""}}) {
    solar.replace(solar.find(from), std::string(from).size(), to);
  }
  CHECK(units_of(read_scene(solar, "scene.toml")) == "1/day au/day ");
}

}  // namespace
}  // namespace noether::test

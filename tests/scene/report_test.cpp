// The report of a run: reasons, notes, figures that are no numbers.

#include "scene/run.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"
#include "tests/support/json.hpp"

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

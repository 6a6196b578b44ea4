// Scenes of first-order systems: the same bits as programs, systems of one's own, changes by --set.

#include "integrators/systems/heat_line.hpp"
#include "integrators/systems/lorenz.hpp"
#include "io/digest.hpp"
#include "scene/evaluate.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <string>

namespace noether::test {
namespace {

const std::string lorenz = R"(units = "reduced"
[system]
type = "lorenz"
rho = 27.5
[integrator]
method = "rk4"
step = 0.01
steps = 60
)";

/// A user's own: the predator and the prey. Doubles only, and no values to start from.
struct Hunt {
  double appetite = 0.5;

  static constexpr auto describe() {
    return part<Hunt>("hunt", "predator and prey", field<&Hunt::appetite>("appetite", "1/time", "of the predator"));
  }
  Index size() const { return 2; }
  void rates(double /*t*/, const Vector<double>& y, Vector<double>& dy) const {
    dy[0] = y[0] - appetite * y[0] * y[1];
    dy[1] = appetite * y[0] * y[1] - y[1];
  }
};

std::string system_refusal(const std::string& text, const Parts& parts, const std::vector<std::string>& sets = {}) {
  try {
    read_scene(text, "scene.toml", parts, sets);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

TEST_CASE("a system's scene and its program end in the same bits, with fixed steps and with free ones", "[scene]") {
  const Scene fixed = read_scene(lorenz, "scene.toml");
  Simulation<double> of_scene = assemble(fixed);
  Simulation program(initial_state(Lorenz{.rho = 27.5}), classical(Lorenz{.rho = 27.5}, method("rk4")), 0.01);
  REQUIRE(of_scene.run(60).ok());
  REQUIRE(program.run(60).ok());
  CHECK(io::digest(of_scene.particles()) == io::digest(program.particles()));

  const Scene free = read_scene(R"(units = "reduced"
[system]
type = "heat_line"
points = 7
[integrator]
method = "dop853"
rtol = 1e-7
until = 0.05
)",
                                "scene.toml");
  const HeatLine line{.points = 7};
  Simulation<double> run = assemble(free);
  Simulation other(initial_state(line), classical(line, method("dop853", {.rtol = 1e-7, .atol = 1e-9})));
  REQUIRE(run.run_until(0.05).ok());
  REQUIRE(other.run_until(0.05).ok());
  CHECK(io::digest(run.particles()) == io::digest(other.particles()));
  CHECK(std::abs(run.particles().variables()[3] - free.system->exact(0.05)[3]) < 1e-6);
}

TEST_CASE("a system of one's own stands in a scene by one line", "[scene]") {
  Parts parts = standard_parts();
  parts.add_system<Hunt>();
  const std::string text = R"(units = "reduced"
[system]
type = "hunt"
appetite = 0.25
start = [3, 1]
[integrator]
method = "rk4"
step = 0.125
steps = 8
)";
  const Scene scene = read_scene(text, "scene.toml", parts);
  Simulation<double> sim = assemble(scene);
  Simulation program(initial_state(Hunt{.appetite = 0.25}, {3, 1}), classical(Hunt{.appetite = 0.25}, method("rk4")),
                     0.125);
  REQUIRE(sim.run(8).ok());
  REQUIRE(program.run(8).ok());
  CHECK(io::digest(sim.particles()) == io::digest(program.particles()));
  CHECK(!scene.system->wide_field);
  CHECK(!scene.system->exact);
  const std::string without = text.substr(0, text.find("start")) + text.substr(text.find("[integrator]"));
  CHECK(system_refusal(without, parts) == "scene.toml:2: system 'hunt' has no start; give start = [...]");
  CHECK(system_refusal(text, standard_parts())
            .starts_with("scene.toml:3: unknown system 'hunt'; expected one of: robertson, "));
}

TEST_CASE("a start of the scene's own takes the place of the system's, and of its closed solution", "[scene]") {
  const std::string text = R"(units = "reduced"
[system]
type = "heat_line"
points = 3
[integrator]
method = "rk4"
step = 0.001
steps = 1
)";
  const Scene own = read_scene(text, "scene.toml"),
              given = read_scene(text, "scene.toml", standard_parts(), {"system.start=[1, 2, 3]"});
  CHECK(own.particles.variables() == HeatLine{.points = 3}.start());
  CHECK(own.system->exact);
  CHECK(given.particles.variables() == std::vector<double>{1, 2, 3});
  CHECK(!given.system->exact);
  CHECK(read_scene(given.effective_toml, "scene.toml").particles.variables() == std::vector<double>{1, 2, 3});
  const Scene longer = read_scene(text, "scene.toml", standard_parts(), {"system.points=5"});
  CHECK(longer.particles.variables().size() == 5);
}

TEST_CASE("the rates of a scene's system are the same in doubles and in extended precision", "[scene]") {
  const Scene scene = read_scene(lorenz, "scene.toml");
  REQUIRE(scene.system->wide_field);
  Vector<double> y(3), dy(3);
  y << 1, 2, 3;
  Vector<Quad> wide(3), wide_dy(3);
  for (Index i = 0; i < 3; ++i) wide[i] = y[i];
  scene.system->field()->rate(0, y, dy);
  scene.system->wide_field()->rate(0, wide, wide_dy);
  for (Index i = 0; i < 3; ++i) CHECK(static_cast<double>(wide_dy[i]) == dy[i]);
}

TEST_CASE("a system has no forces to evaluate", "[scene][messages]") {
  const Scene scene = read_scene(lorenz, "scene.toml");
  CHECK_THROWS_WITH(evaluate(scene, false),
                    "scene.toml: there is nothing to evaluate: system 'lorenz' has neither energy nor forces; `noether "
                    "explain` shows how stiff it is");
  const Scene orbit = read_scene(
      "units = \"reduced\"\n[system]\ntype = \"polar_kepler\"\n[integrator]\nmethod = \"galerkin_gauss_2\"\nstep = "
      "0.1\nsteps = 10\n",
      "scene.toml");
  CHECK_THROWS_WITH(evaluate(orbit, false),
                    "scene.toml: there is nothing to evaluate: system 'polar_kepler' has no forces on particles; the "
                    "monitor 'energy' shows its energy, and `noether explain` shows how stiff it is");
}

TEST_CASE("the monitor of variables follows one of them by name or by number", "[scene]") {
  const auto last = [](const std::string& variable) {
    const Scene scene = read_scene(
        lorenz + "[[every]]\ntype = \"variables\"\nsteps = 1\nvariable = \"" + variable + "\"\n", "scene.toml");
    Simulation<double> sim = assemble(scene);
    REQUIRE(sim.run(10).ok());
    std::optional<MonitorReport> report;
    sim.for_each_monitor([&](const std::string&, AnyMonitor<double>& monitor) { report = monitor.report(); });
    REQUIRE(report);
    CHECK(report->samples == 11);
    CHECK(report->first == 1.0);
    return std::pair(*report->last, sim.particles().variables());
  };
  for (const auto& [name, place] : {std::pair{"", 0}, std::pair{"x", 0}, std::pair{"z", 2}, std::pair{"y[1]", 1}}) {
    const auto [figure, y] = last(name);
    CHECK(figure == y[static_cast<std::size_t>(place)]);
  }
}

}  // namespace
}  // namespace noether::test

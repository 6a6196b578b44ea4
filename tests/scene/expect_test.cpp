// What ends no run: an [expect] that no run can be compared with, a [[verdict]] that judges none. And what names its
// way out: parts of other programs.

#include "scene/scene.hpp"
#include "scene/warnings.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"

#include <string>

namespace noether::test {
namespace {

const std::string expected_spring = R"(units = "reduced"
[particles]
body = [{ name = "ball", mass = 1, x = [1, 0, 0], v = [0, 0, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "harmonic_field"
k = 1
[integrator]
method = "verlet"
step = 0.1
steps = 10
[[every]]
type = "energy"
steps = 1
)";

/// The one thing that is wrong with what a scene expects; "" if nothing.
std::string wrong_expectation_of(const std::string& lines) {
  const Scene scene = read_scene(expected_spring + lines, "scene.toml");
  CHECK(scene.unread == warnings_of(scene));
  return scene.unread.empty() ? "" : scene.unread.at(0);
}

TEST_CASE("what [expect] says wrongly is a warning with its line, and ends no run", "[scene][messages]") {
  CHECK(wrong_expectation_of("[expect]\nenergy.worst = 1e-3\n").empty());
  CHECK(wrong_expectation_of("[expect]\nenergy.worst = 1\n").empty());
  CHECK(wrong_expectation_of("[expect]\nenergy.worst = \"small\"\n") ==
        "scene.toml:17: energy.worst = \"small\" is a text; a number is expected");
  CHECK(wrong_expectation_of("[expect]\nenergy.wurst = 1e-3\n") ==
        "scene.toml:17: [expect] names 'wurst' of 'energy', which is not a figure; did you mean 'worst'?");
  CHECK(wrong_expectation_of("[expect]\nenrgy.worst = 1e-3\n") ==
        "scene.toml:17: [expect] names 'enrgy', which is not a monitor of this scene; did you mean 'energy'?");
  CHECK(wrong_expectation_of("[expect]\nenergy = 1e-3\n") ==
        "scene.toml:17: [expect] names no figure of 'energy'; expected one, such as energy.worst");
  const Scene scene = read_scene("expect = 3\n" + expected_spring, "scene.toml");
  CHECK(scene.unread == std::vector<std::string>{"scene.toml:1: expect = 3 is a whole number; a table is expected"});
  Simulation<double> sim = assemble(scene);
  CHECK(sim.run(10).ok());
}

/// The one thing that is wrong with a verdict; "" if nothing.
std::string wrong_verdict_of(const std::string& lines) {
  const Scene scene =
      read_scene(expected_spring + "[[verdict]]\n" + lines + "\n[[verdict]]\noutcome = \"unbounded\"\n", "scene.toml");
  Simulation<double> sim = assemble(scene);
  CHECK(sim.run(10).ok());
  REQUIRE_FALSE(scene.verdicts.empty());
  CHECK(scene.verdicts.back().outcome == "unbounded");  // the others are read all the same
  const std::vector<std::string> warnings = warnings_of(scene);
  CHECK(scene.verdicts.size() + warnings.size() == 2);
  return warnings.empty() ? "" : warnings.at(0);
}

TEST_CASE("what a [[verdict]] says wrongly is a warning with its line, and ends no run", "[scene][messages]") {
  CHECK(wrong_verdict_of("energy_below = 1e-3").empty());
  CHECK(wrong_verdict_of("energy_below = -1") ==
        "scene.toml:17: energy_below = -1 is not a valid bound of an error; a number above 0 is expected");
  CHECK(
      wrong_verdict_of("methods = \"verlet\"") ==
      "scene.toml:17: methods = \"verlet\" is a text; a list of texts, such as [\"verlet\"], or \"all\", is expected");
  CHECK(wrong_verdict_of("energy_bellow = 1") ==
        "scene.toml:17: unknown key 'energy_bellow' in [[verdict]]; did you mean 'energy_below'?");
  CHECK(wrong_verdict_of("outcome = \"bounde\"") == "scene.toml:17: unknown outcome 'bounde'; did you mean 'bounded'?");
  const Scene scene = read_scene("verdict = 3\n" + expected_spring, "scene.toml");
  CHECK(warnings_of(scene) ==
        std::vector<std::string>{"scene.toml:1: verdict is a whole number; tables headed [[verdict]] are expected"});
}

TEST_CASE("the energy of a scene without [[every]] can be expected", "[scene]") {
  const std::string unwatched = expected_spring.substr(0, expected_spring.find("[[every]]"));
  CHECK(read_scene(unwatched + "[expect]\nenergy.worst = 1e-3\n", "scene.toml").unread.empty());
}

TEST_CASE("a part that is not known here points to the program of the scene", "[scene][messages]") {
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      read_scene(text, "scene.toml");
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  };
  const std::string own = "program = \"./springs\"\n" + expected_spring;
  CHECK(refusal(own).empty());
  CHECK(refusal(replaced(own, "\"harmonic_field\"", "\"cubic_well\"")) ==
        "scene.toml:8: unknown force 'cubic_well'; the program of this scene has more parts: run `./springs`");
  CHECK(
      refusal(replaced(own, "\"harmonic_field\"", "\"harmonic_feild\"")) ==
      "scene.toml:8: unknown force 'harmonic_feild'; did you mean 'harmonic_field'? If not, the program of this scene "
      "has more parts: run `./springs`");
  CHECK_FALSE(has(read_scene(own, "scene.toml").effective_toml, "springs"));
  for (const std::string example : {"bead_on_wire", "beads_on_sphere", "oblate_saturn"}) {
    INFO(example);
    const std::string folder = "examples/" + example;
    const std::string text = read_text(std::string(NOETHER_SOURCE_DIR) + "/" + folder + "/scene.toml");
    try {
      read_scene(text, std::string(NOETHER_SOURCE_DIR) + "/" + folder + "/scene.toml");
      FAIL("it is not refused");
    } catch (const SceneError& error) {
      CHECK(has(error.what(), "the program of this scene has more parts: run `./noether build && cd " + folder +
                                  " && ../../build/release/examples/example_" + example + "_from_scene`"));
    }
  }
}

}  // namespace
}  // namespace noether::test

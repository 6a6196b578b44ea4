/// A decorator of integrators from outside the library (tests/support/energy_projection.hpp), with an option and a
/// state of its own, through every command of a program that knows it.

#include "io/inspect.hpp"
#include "tests/cli/support.hpp"

#include <charconv>
#include <cmath>
#include <string>
#include <vector>

namespace noether::test {
namespace {

/// A planet on an eccentric orbit; every tenth step its energy is put back to that of the start.
const std::string held_orbit = R"(title = "A planet whose energy is held"
units = "reduced"
[[particles.body]]
name = "sun"
mass = 1
x = [0, 0, 0]
v = [0, 0, 0]
[[particles.body]]
name = "planet"
mass = 0.01
x = [1, 0, 0]
v = [0, 0.8, 0.1]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "gravity"
[integrator]
method = "verlet"
step = 0.02
steps = 500
[[integrator.decorator]]
type = "energy_projection"
steps = 10
[[every]]
type = "energy"
steps = 10
[[every]]
type = "trajectory"
steps = 50
[[every]]
type = "checkpoint"
steps = 100
)";
/// The same by a method that chooses its steps.
const std::string adaptive =
    " --set integrator.method=dop853 --set integrator.step= --set integrator.steps= --set integrator.until=10";
const std::string without = " --set integrator.decorator=";

double number(const std::string& text) {
  double value = std::nan("");
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}
/// The values of a key in every row.
std::vector<double> numbers_of(const std::string& json, const std::string& key) {
  std::vector<double> all;
  const std::string mark = "\"" + key + "\":";
  for (std::size_t at = json.find(mark); at != std::string::npos; at = json.find(mark, at + 1)) {
    all.push_back(number(json_member(json.substr(at), key)));
  }
  return all;
}

}  // namespace

TEST_CASE("a decorator from outside the library is listed, described and explained", "[cli][own_decorator]") {
  const SceneFolder folder(held_orbit);
  CHECK(has(own_output(folder, "list decorators"), "energy_projection  scales velocities back to the energy"));
  CHECK_FALSE(has(output(folder, "list decorators"), "energy_projection"));
  const std::string described = own_output(folder, "describe energy_projection");
  CHECK(has(described, "energy_projection (decorator): scales velocities back"));
  CHECK(has(described, "  belongs in [integrator.NAME], or [[integrator.decorator]] with type"));
  CHECK(has(described, "\n  steps          whole number [1], default 10: steps between two projections\n"));
  CHECK(has(own_output(folder, "explain scene.toml"), "\n  decorator energy_projection, steps 10\n"));
  CHECK(has(own_output(folder, "explain scene.toml --all" + without), "left out:\n"));
  CHECK(has(own_output(folder, "explain scene.toml --all" + without), "\n  decorator energy_projection\n"));
}

TEST_CASE("it holds the energy of a splitting and of methods for y' = f", "[cli][own_decorator]") {
  const SceneFolder folder(held_orbit);
  const auto worst = [&](const std::string& sets) {
    const std::string report = own_output(folder, "run scene.toml --json --fresh --out a" + sets);
    return number(json_member(json_member(report, "energy"), "worst"));
  };
  for (const char* method : {"verlet", "rk4", "adams_bashforth_3", "implicit_midpoint"}) {
    CAPTURE(method);
    const std::string by = " --set integrator.method=" + std::string(method);
    CHECK(worst(by) < 1e-14);
    CHECK(worst(by + without) > 1e-8);
    CHECK(worst(by + " --set integrator.decorator.energy_projection.steps=20") > 1e-9);  // seen between two projections
  }
  const std::string coarse = adaptive + " --set integrator.rtol=1e-5 --set integrator.atol=1e-5";
  CHECK(worst(coarse) < 1e-14);
  CHECK(worst(coarse + without) > 1e-8);
}

TEST_CASE("decorated runs have the same bits on any threads, at any cadence and across a restart",
          "[cli][own_decorator]") {
  for (const std::string& sets : {std::string(), std::string(" --set integrator.method=stormer_cowell_12"),
                                  std::string(" --set integrator.compensated=true"), adaptive}) {
    CAPTURE(sets);
    const SceneFolder folder(held_orbit);
    const std::string digest = own_digest(folder, "a" + sets);
    CHECK(own_digest(folder, "b --threads 2" + sets) == digest);
    CHECK(own_digest(folder, "c --set every.0.steps=1" + sets) == digest);
    CHECK(own_digest(folder, "e --set every.0.steps=7" + sets) == digest);
    // 3.3 lies between two projections: what the run is to be put back to is state, not what it then has.
    own_output(folder, "run scene.toml --quiet --out d --until 3.3" + sets);
    CHECK(own_digest(folder, "d --resume --until 10" + sets) == digest);
    CHECK(own_digest(folder, "f" + sets + without) != digest);
    CHECK(own_digest(folder, "g" + sets + " --set integrator.decorator.0.steps=3") != digest);
  }
}

TEST_CASE("its runs can be verified, drawn and converted, and tell the scene with it", "[cli][own_decorator]") {
  const SceneFolder folder(held_orbit);
  own_output(folder, "run scene.toml --quiet --out a --set integrator.decorator.0.steps=5");
  CHECK(own(folder, "verify a/run.h5").exit_code == 0);
  own_output(folder, "plot a/run.h5 --out picture.svg");
  CHECK(has(own_output(folder, "info a/run.h5"), "2 particles"));
  own_output(folder, "convert a/run.h5 a.csv");
  CHECK(has(read_text(folder / "a.csv"), "planet"));
  const std::string scene = io::info(folder / "a/run.h5").scene_toml;
  CHECK(has(scene, "[[integrator.decorator]]\ntype = \"energy_projection\"\nsteps = 5\n"));
  // A scene as it was run reads back to the same run.
  write_text(folder / "again.toml", scene);
  const std::string first = json_member(own_output(folder, "run scene.toml --json --out b"), "digest");
  const std::string again =
      json_member(own_output(folder, "run again.toml --json --out c --set integrator.decorator.0.steps=10"), "digest");
  CHECK(again == first);
}

TEST_CASE("a run that was decorated in another way is not gone on with", "[cli][own_decorator]") {
  const SceneFolder folder(held_orbit);
  own_output(folder, "run scene.toml --quiet --out a --until 3.3");
  const auto refused = [&](const std::string& sets) {
    return own(folder, "run scene.toml --quiet --out a --resume" + sets).err;
  };
  CHECK(has(refused(" --set integrator.decorator.0.steps=5"), "integrator.decorator.0.steps = 5 was 10"));
  CHECK(has(refused(without), "is missing now"));
}

TEST_CASE("several decorators stand around each other in their order", "[cli][own_decorator]") {
  const SceneFolder folder(held_orbit);
  const std::string two = " --set 'integrator.decorator.1={type=\"energy_projection\", steps=15}'";
  const std::string digest = own_digest(folder, "a" + two);
  CHECK(own_digest(folder, "b") != digest);
  own_output(folder, "run scene.toml --quiet --out c --until 3.3" + two);
  CHECK(own_digest(folder, "c --resume --until 10" + two) == digest);
  const std::string explained = own_output(folder, "explain scene.toml" + two);
  CHECK(has(explained, "  decorator energy_projection, steps 10\n  decorator energy_projection, steps 15\n"));
}

TEST_CASE("whatever method is compared is decorated, and the truth says that it is not", "[cli][own_decorator]") {
  const SceneFolder folder(held_orbit);
  const std::string line =
      "compare scene.toml --methods verlet,yoshida_4,rk4,dop853 --steps 0.02,0.01 --tolerances 1e-8 --repeat 1 --json";
  const std::string table = own_output(folder, line + " --set integrator.decorator.0.steps=1");
  CHECK(has(table, "in quad"));
  CHECK(has(table, "; decorator 'energy_projection' is left out of it"));
  for (const char* label : {"verlet", "yoshida_4", "rk4", "dop853"})
    CHECK(has(table, "\"" + std::string(label) + "\""));
  const std::vector<double> held = numbers_of(table, "energy_error_max");
  const std::vector<double> free = numbers_of(own_output(folder, line + " --out x" + without), "energy_error_max");
  REQUIRE(held.size() == 7);
  REQUIRE(free.size() == 7);
  for (std::size_t k = 0; k < 6; ++k) {  // the last has steps of its own, which moments lie between
    CAPTURE(k);
    CHECK(held[k] < 1e-13);
    CHECK(free[k] > 1e-11);
  }
  CHECK_FALSE(has(own_output(folder, line + " --out y" + without), "is left out of it"));
}

TEST_CASE("limits are those of decorated steps, of which linear theory says nothing", "[cli][own_decorator]") {
  // An oscillator: the bare method is bounded up to h omega = 2.
  const SceneFolder folder(held_orbit);
  const std::string line =
      "stability scene.toml --methods verlet --steps 1000 --budget 3 --set "
      "'hamiltonian.force=[{type=\"harmonic_field\", k=1}]' --set particles.body.planet.mass=1";
  const std::string held = own_output(folder, line);
  CHECK(has(held,
            "every method is wrapped by energy_projection, so linear theory, which is for bare methods, is left out"));
  const std::string free = own_output(folder, line + without);
  CHECK_FALSE(has(free, "energy_projection"));
  CHECK(json_member(own_output(folder, line + " --json"), "theory_known") == "false");
  CHECK(json_member(own_output(folder, line + " --json" + without), "theory_known") == "true");
}

TEST_CASE("advice keeps the decorator, and evaluations are those of its forces", "[cli][own_decorator]") {
  const SceneFolder folder(held_orbit);
  const std::string advice = own_output(folder, "advise scene.toml --error 1e-4 --methods yoshida_4,dop853");
  CHECK(has(advice, "cheapest: "));
  CHECK(has(advice, "--set 'integrator.method="));
  CHECK_FALSE(has(advice, "decorator="));
  CHECK(has(own_output(folder, "evaluate scene.toml"), "gravity"));
}

TEST_CASE("what a decorator cannot do is refused by name", "[cli][own_decorator]") {
  const SceneFolder folder(held_orbit);
  const auto refused = [&](const std::string& sets) { return own(folder, "run scene.toml" + sets).err; };
  CHECK(has(refused(" --set integrator.decorator.0.type=energy_projectoin"),
            "unknown decorator 'energy_projectoin'; did you mean 'energy_projection'?"));
  CHECK(has(refused(" --set integrator.decorator.0.step=3"),
            "unknown key 'step' in decorator 'energy_projection'; did you mean 'steps'?"));
  CHECK(has(refused(" --set integrator.decorator.0.steps=0"), "steps = 0 is too few; at least 1 is expected"));
  CHECK(has(refused(" --set integrator.decorator.0.type="),
            "this decorator has no type; expected one of: projection, energy_projection"));
  CHECK(has(refused(" --set integrator.decorator=7"), "tables headed [[integrator.decorator]] are expected"));
  CHECK(has(refused(" --set every.0.type=shadow_hamiltonian"), "velocities are scaled by energy_projection"));
  CHECK(has(noether(folder, "explain scene.toml").err, "scene.toml:22: unknown decorator 'energy_projection'"));

  const SceneFolder kinetics(R"(title = "No energy"
units = "reduced"
[system]
type = "lorenz"
[integrator]
method = "dop853"
until = 1
[[integrator.decorator]]
type = "energy_projection"
)");
  CHECK(has(own(kinetics, "run scene.toml").err,
            "scene.toml:9: energy_projection keeps an energy, and 'lorenz' has none"));
}

}  // namespace noether::test

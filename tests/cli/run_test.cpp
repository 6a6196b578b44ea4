// `noether run`: what it prints, and with which exit code.

#include "tests/cli/support.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace noether::test {
namespace {

TEST_CASE("a run reports in text, and in a pipe shows no progress", "[cli][run]") {
  const SceneFolder folder(unwritten);
  const ProcessResult result = noether(folder, "run scene.toml");
  CHECK(result.exit_code == 0);
  CHECK(result.err.empty());
  INFO(result.out);
  CHECK(result.out.starts_with("completed at step 100, time 1\nenergy: worst "));
  CHECK(result.out.find("\nangular_momentum: worst ") != std::string::npos);
  CHECK(result.out.find("100 steps of yoshida_4 over kinetic_potential in ") != std::string::npos);
  const auto last = result.out.rfind("\nsha256:");
  REQUIRE(last != std::string::npos);
  CHECK(result.out.size() == last + 1 + 7 + 64 + 1);
}

TEST_CASE("--cost tells the seconds of each part, which add up to those of the run, and changes no bit",
          "[cli][run][json]") {
  const SceneFolder folder(R"(units = "reduced"
[particles]
type = "lattice"
lattice = "fcc"
cells = [3, 3, 3]
density = 0.8442
mass = 1
temperature = 1.44
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "lennard_jones"
cutoff = 2
epsilon = 1
sigma = 1
[[hamiltonian.constraint]]
type = "distance"
pairs = [["atom_1", "atom_2"]]
[hamiltonian.thermostat]
type = "langevin"
temperature = 1.44
friction = 1
[integrator]
method = "BAOAB"
step = 0.002
steps = 200
[[every]]
type = "radial_distribution"
steps = 5
)");
  const std::string told = output(folder, "run scene.toml --json --cost --out told");
  REQUIRE(is_json_line(told));
  const std::string plain = output(folder, "run scene.toml --json --out plain");
  const auto digest = [](const std::string& json) {
    return json.substr(json.find("sha256:", json.find("digest")), 71);
  };
  CHECK(digest(told) == digest(plain));
  CHECK(plain.find("\"cost\"") == std::string::npos);
  const auto number = [&](const std::string& key, std::size_t from) {
    return std::stod(told.substr(told.find(key, from) + key.size()));
  };
  double sum = 0, share = 0;
  for (const char* part : {R"("kind":"force","name":"lennard_jones")", R"("kind":"neighbors","name":null)",
                           R"("kind":"constraints","name":null)", R"("kind":"thermostat","name":"langevin")",
                           R"("kind":"monitor","name":"radial_distribution")", R"("kind":"integrator","name":null)"}) {
    CAPTURE(part, told);
    const std::size_t at = told.find(part);
    REQUIRE(at != std::string::npos);
    CHECK(number("\"seconds\":", at) > 0);
  }
  for (std::size_t at = told.find("\"kind\":"); at != std::string::npos; at = told.find("\"kind\":", at + 1)) {
    sum += number("\"seconds\":", at);
    share += number("\"share\":", at);
  }
  CHECK(std::abs(share - 1) < 1e-12);
  // The book is open a little longer than the run is timed.
  CHECK(sum >= number("\"wall_s\":", 0));
  CHECK(sum < number("\"wall_s\":", 0) + 0.5);
  const std::string text = output(folder, "run scene.toml --cost --out text");
  CHECK(text.find("\ncost: ") != std::string::npos);
  CHECK(text.find("force lennard_jones ") != std::string::npos);
}

TEST_CASE("--json is one line with every key, in one order", "[cli][run][json]") {
  const SceneFolder folder(unwritten);
  const ProcessResult result = noether(folder, "run scene.toml --json");
  CHECK(result.exit_code == 0);
  CHECK(result.err.empty());
  INFO(result.out);
  REQUIRE(is_json_line(result.out));
  std::size_t at = 0;
  for (const char* key : {"schema",
                          "version",
                          "commit",
                          "scene",
                          "scene_sha256",
                          "outcome",
                          "exit_code",
                          "message",
                          "particle",
                          "quantity",
                          "step",
                          "time",
                          "time_unit",
                          "dt",
                          "particles",
                          "resumed_from_step",
                          "threads",
                          "simd",
                          "evaluations",
                          "force",
                          "kepler",
                          "jacobian",
                          "wall_s",
                          "steps_per_s",
                          "particle_steps_per_s",
                          "digest",
                          "monitors",
                          "energy",
                          "first",
                          "last",
                          "worst",
                          "rms",
                          "slope",
                          "slope_error",
                          "slope_unit",
                          "scale",
                          "samples",
                          "angular_momentum",
                          "files",
                          "trajectory",
                          "checkpoint"}) {
    const auto found = result.out.find("\"" + std::string(key) + "\":", at);
    INFO(key);
    REQUIRE(found != std::string::npos);
    at = found;
  }
  CHECK(json_member(result.out, "schema") == "\"noether.run/1\"");
  CHECK(json_member(result.out, "scene") == "\"scene.toml\"");
  CHECK(json_member(result.out, "outcome") == "\"completed\"");
  CHECK(json_member(result.out, "exit_code") == "0");
  CHECK(json_member(result.out, "step") == "100");
  CHECK(json_member(result.out, "time") == "1");
  CHECK(json_member(result.out, "dt") == "0.01");
  CHECK(json_member(result.out, "particles") == "2");
  CHECK(json_member(result.out, "particle") == "null");
  CHECK(json_member(result.out, "quantity") == "null");
  CHECK(json_member(result.out, "resumed_from_step") == "null");
  CHECK(json_member(json_member(result.out, "evaluations"), "force") == "300");
  CHECK(json_member(json_member(result.out, "energy"), "samples") == "11");
  CHECK(json_member(json_member(result.out, "angular_momentum"), "samples") == "15");
}

TEST_CASE("evaluate and explain warn as run does, also of an [expect] that ends no run", "[cli][run][evaluate]") {
  const SceneFolder folder(unwritten + "[expect]\nenrgy.worst = 1\n");
  const std::string warning =
      "scene.toml:28: [expect] names 'enrgy', which is not a monitor of this scene; did you mean 'energy'?";
  for (const char* command : {"run", "evaluate", "explain"}) {
    INFO(command);
    const ProcessResult result = noether(folder, std::string(command) + " scene.toml");
    CHECK(result.exit_code == 0);
    CHECK(has(result.out, "\nwarning: " + warning + "\n"));
  }
  for (const char* line : {"run scene.toml --json --out b", "evaluate scene.toml --json"}) {
    CHECK(json_member(noether(folder, line).out, "warnings") == "[\"" + warning + "\"]");
  }
}

TEST_CASE("one is not many", "[cli][run]") {
  const SceneFolder folder(exploding);
  const ProcessResult result = noether(folder, "run scene.toml --threads 1 --set integrator.steps=1");
  INFO(result.out);
  CHECK(has(result.out, "(1 sample)\n"));
  CHECK(has(result.out, "\n1 step of verlet over kinetic_potential in "));
  CHECK(has(result.out, " on 1 thread\n"));
  CHECK(has(noether(folder, "explain scene.toml").out, "verlet over kinetic_potential, 1 particle\n"));
  if (NOETHER_HDF5 == 0) return;
  CHECK(has(noether(folder, "info scene.out/checkpoint.h5").out, "\n  1 particle, step 1, "));
}

TEST_CASE("--quiet prints nothing", "[cli][run]") {
  const SceneFolder folder(unwritten);
  const ProcessResult result = noether(folder, "run scene.toml --quiet");
  CHECK(result.exit_code == 0);
  CHECK((result.out + result.err).empty());
}

TEST_CASE("--until and --set change the scene of one run", "[cli][run]") {
  const SceneFolder folder(unwritten);
  CHECK(json_member(noether(folder, "run scene.toml --json --out a --until 0.25").out, "step") == "25");
  const std::string whole = noether(folder, "run scene.toml --json --out b").out;
  const std::string set = noether(folder,
                                  "run scene.toml --json --out c --set integrator.method=verlet "
                                  "--set 'particles.body.Planet.v=[0, 1.1, 0]' --set integrator.steps=50")
                              .out;
  CHECK(json_member(set, "step") == "50");
  CHECK(json_member(set, "scene_sha256") != json_member(whole, "scene_sha256"));
  write_text(folder / "scene.toml",
             replaced(replaced(replaced(unwritten, "yoshida_4", "verlet"), "v = [0, 1, 0]", "v = [0, 1.1, 0]"),
                      "steps = 100", "steps = 50"));
  const std::string written = noether(folder, "run scene.toml --json --out d").out;
  CHECK(json_member(written, "scene_sha256") == json_member(set, "scene_sha256"));
  CHECK(json_member(written, "digest") == json_member(set, "digest"));
}

TEST_CASE("a thermostat is reached by --set, one that is written and one that is not", "[cli][run]") {
  const std::string bath = read_text(std::filesystem::path(NOETHER_SOURCE_DIR) / "tests/scenes/good/bath.toml");
  const SceneFolder folder(bath);
  int number = 0;
  const auto run = [&](const std::string& more) {
    const ProcessResult result = noether(folder, fmt::format("run scene.toml --json --out {}{}", ++number, more));
    CHECK(result.err.empty());
    return json_member(result.out, "scene_sha256") + json_member(result.out, "digest");
  };
  const std::string as_written = run("");
  std::vector<std::string> found;
  for (const auto& [key, old, now] : std::vector<std::array<std::string, 3>>{
           {"temperature", "\"300 K\"", "\"310 K\""}, {"friction", "\"1/ps\"", "\"2/ps\""}, {"seed", "7", "8"}}) {
    CAPTURE(key);
    found.push_back(run(" --set 'hamiltonian.thermostat." + key + "=" + now + "'"));
    CHECK(found.back() != as_written);
    write_text(folder / "scene.toml", replaced(bath, key + " = " + old, key + " = " + now));
    CHECK(run("") == found.back());
    write_text(folder / "scene.toml", bath);
  }
  const std::string table = bath.substr(bath.find("[hamiltonian.thermostat]"),
                                        bath.find("[integrator]") - bath.find("[hamiltonian.thermostat]"));
  write_text(folder / "scene.toml", replaced(bath, table, ""));
  CHECK(run(" --set hamiltonian.thermostat.type=langevin --set 'hamiltonian.thermostat.temperature=\"300 K\"'"
            " --set 'hamiltonian.thermostat.friction=\"1/ps\"' --set hamiltonian.thermostat.seed=7") == as_written);
  write_text(folder / "scene.toml", bath);
  const auto refused = [&](const std::string& set) {
    const ProcessResult result = noether(folder, "run scene.toml --out none --set " + set);
    CHECK(result.exit_code == 2);
    return result.err;
  };
  CHECK(refused("hamiltonian.thermostat.temprature=3") ==
        "--set hamiltonian.thermostat.temprature=3: unknown key 'temprature' in thermostat 'langevin'; did you mean "
        "'temperature'?\n");
  CHECK(has(refused("hamiltonian.thermostat.temperature=-3"), "--set hamiltonian.thermostat.temperature=-3: "));
  CHECK(has(refused("'hamiltonian.thermostat.friction=\"2 ps\"'"), "friction"));
}

TEST_CASE("the number of threads does not change the bits", "[cli][run][determinism]") {
  const SceneFolder folder(unwritten);
  std::vector<std::string> digests;
  for (const char* threads : {"1", "2", "3"}) {
    const std::string json =
        noether(folder, std::string("run scene.toml --json --out ") + threads + " --threads " + threads).out;
    CHECK(json_member(json, "digest").size() == 2 + 7 + 64);
    digests.push_back(json_member(json, "digest"));
  }
  CHECK(digests[1] == digests[0]);
  CHECK(digests[2] == digests[0]);
}

TEST_CASE("a run that the scene stops exits 0 and says who did it", "[cli][run]") {
  const SceneFolder folder(replaced(unwritten, "v = [0, 1, 0]", "v = [9, 0, 0]") +
                           "[[stop]]\ntype = \"escape\"\ndistance = 2\nsteps = 5\n");
  const ProcessResult result = noether(folder, "run scene.toml --json");
  CHECK(result.exit_code == 0);
  CHECK(json_member(result.out, "outcome") == "\"stopped\"");
  CHECK(json_member(result.out, "step") == "15");
  CHECK(json_member(result.out, "message").starts_with("\"escape of Planet, distance 2."));
  CHECK(json_member(result.out, "particle") == R"({"index":1,"id":1,"name":"Planet"})");
}

TEST_CASE("a run whose numbers run away exits 1, with a whole report", "[cli][run]") {
  const SceneFolder folder(exploding);
  const ProcessResult result = noether(folder, "run scene.toml --json");
  CHECK(result.exit_code == 1);
  const std::string step = json_member(result.out, "step");
  CHECK(result.err == "diverged at step " + step + ": velocity of ball is not finite\n");
  CHECK(std::stoi(step) <= 160);  // 98^155 is beyond all numbers
  INFO(result.out);
  CHECK(is_json_line(result.out));
  CHECK(json_member(result.out, "outcome") == "\"diverged\"");
  CHECK(json_member(result.out, "exit_code") == "1");
  CHECK(json_member(result.out, "message") == "\"velocity of ball is not finite\"");
  CHECK(json_member(result.out, "particle") == R"({"index":0,"id":0,"name":"ball"})");
  CHECK(json_member(result.out, "quantity") == "\"velocity\"");
  CHECK(json_member(json_member(result.out, "energy"), "worst") == "null");
  const ProcessResult text = noether(folder, "run scene.toml --out text");
  CHECK(text.exit_code == 1);
  CHECK(text.err == result.err);
  CHECK(text.out.starts_with("diverged at step " + step + ", time " + step + "\n"));  // the reason is told once
  CHECK(text.out.find("nan") == std::string::npos);
}

TEST_CASE("two bodies that fall into one point exit 1", "[cli][run]") {
  // From rest at +-1/2, one step of length 1 brings both to the origin.
  const SceneFolder folder(R"(units = "reduced"
[particles]
body = [{ name = "left", mass = 1, x = [-0.5, 0, 0], v = [0, 0, 0] },
        { name = "right", mass = 1, x = [0.5, 0, 0], v = [0, 0, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "gravity"
[integrator]
method = "verlet"
step = 1
steps = 10
)");
  const ProcessResult result = noether(folder, "run scene.toml --json");
  CHECK(result.exit_code == 1);
  CHECK(is_json_line(result.out));
  CHECK(json_member(result.out, "outcome") == "\"diverged\"");
}

}  // namespace
}  // namespace noether::test

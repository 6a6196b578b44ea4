// `noether stability`: rows, verdicts, reports, words.

#include "tests/cli/support.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <string>

namespace noether::test {
namespace {

const std::string spring = R"(title = "A spring"
units = "reduced"
[particles]
body = [{ name = "ball", mass = 1, x = [1, 0, 0], v = [0, 0.5, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "harmonic_field"
k = 4
[integrator]
method = "verlet"
step = 0.05
steps = 2000
)";

const std::string verdicts = spring + R"([[verdict]]
methods = ["verlet", "rk4"]
outcome = "theory"
[[verdict]]
set = ["integrator.step=1.05"]
outcome = "unbounded"
[[verdict]]
outcome = "unbounded"
why = "which is wrong"
)";

TEST_CASE("stability tells the limit of a method beside theory, as a table or in one line of JSON",
          "[cli][stability]") {
  const SceneFolder folder(spring);
  const std::string json = output(folder, "stability scene.toml --methods verlet --steps 20000 --json");
  CHECK(is_json_line(json));
  CHECK(json.starts_with("{\"schema\":\"noether.stability/1\""));
  for (const char* key : {"method", "limit_step", "limit_h_omega", "theory", "reason", "gap_end", "recommended_step"}) {
    CAPTURE(key);
    CHECK(has(json, fmt::format("\"{}\":", key)));
  }
  CHECK(std::abs(std::stod(json_member(json, "limit_step")) - 1) < 1e-3);
  CHECK(std::abs(std::stod(json_member(json, "limit_h_omega")) - 2) < 1e-3);
  CHECK(std::abs(std::stod(json_member(json, "theory")) - 2) < 1e-6);
  CHECK(json_member(json, "reason") == "\"linear\"");
  const std::string text = output(folder, "stability scene.toml --methods rk4 --steps 2e4");
  CHECK(text.starts_with("fastest oscillation: omega = 2, period 3.14159, linear\n"));
  CHECK(has(text, "2.82843"));
}

TEST_CASE("stability writes a report where it is told, and nothing else", "[cli][stability]") {
  const SceneFolder folder(spring);
  output(folder, "stability scene.toml --methods verlet --steps 20000");
  CHECK_FALSE(std::filesystem::exists(folder / "stability.out"));
  const std::string text = output(folder, "stability scene.toml --methods verlet,rk4 --steps 20000 --out limits");
  CHECK(text.ends_with("wrote limits/stability.json\nwrote limits/report.html\n"));
  CHECK(is_json_line(read_text(folder / "limits/stability.json")));
  const std::string page = read_text(folder / "limits/report.html");
  for (const char* part : {"<h1>Largest stable steps: A spring</h1>", "data-name=\"verlet\"", "data-name=\"rk4\""}) {
    CHECK(has(page, part));
  }
  CHECK_FALSE(has(page, "class=\"row alarm\""));  // both limits are the linear ones
}

TEST_CASE("stability --suite runs the verdicts of a scene into a report", "[cli][stability]") {
  const SceneFolder folder(verdicts);
  const std::string text = output(folder, "stability --suite scene.toml");
  INFO(text);
  CHECK(text.ends_with("3 of 4 verdicts hold\nwrote stability.out/suite.json\nwrote stability.out/report.html\n"));
  CHECK(is_json_line(read_text(folder / "stability.out/suite.json")));
  CHECK(has(read_text(folder / "stability.out/report.html"), "which is wrong"));
  const std::string json = output(folder, "stability --suite scene.toml --json --out elsewhere");
  CHECK(is_json_line(json));
  CHECK(has(json, "\"agreeing\":3"));
  CHECK(std::filesystem::exists(folder / "elsewhere/report.html"));
}

TEST_CASE("wrong requests to stability are told in one line", "[cli][stability][wrong]") {
  const SceneFolder folder(spring);
  const auto wrong = [&](const std::string& line, const std::string& message) {
    const ProcessResult result = noether(folder, line);
    INFO(line << "\n" << result.err);
    CHECK(result.exit_code == 2);
    CHECK(result.err == message + "\n");
    CHECK(result.out.empty());
  };
  const std::string see = "; see `noether stability --help`";
  wrong("stability", "no scene is given; give one, or --suite for the scenes that come with noether");
  wrong("stability scene.toml --nightly", "--nightly belongs to --suite; give both, or leave it out");
  wrong("stability --suite scene.toml --methods rk4",
        "--suite runs the methods and changes of its verdicts; leave --methods and --set out");
  wrong("stability --suite scene.toml", "scene.toml: the scene has no verdict; give [[verdict]] tables");
  wrong("stability scene.toml --methods verlt", "unknown method 'verlt'; did you mean 'verlet'?");
  wrong("stability scene.toml --methods bdf",
        "method 'bdf' chooses its steps by a tolerance, so it has no largest step; give one of fixed steps, such as "
        "'rk4'");
  wrong("stability scene.toml --methods ''", "--methods '': a part of the list is empty");
  wrong("stability scene.toml --budget 0", "--budget: '0' is not a number of seconds above 0" + see);
  wrong("stability scene.toml --steps 1e4.5", "--steps: '1e4.5' is not a whole number above 0" + see);
  wrong("stability scene.toml --steps 1e4 --methods rk5", "unknown method 'rk5'; did you mean 'rk4'?");
  wrong("stability scene.toml --steps 10", "10 steps are too few; 1000 or more are expected");
  wrong("stability --suite scene.toml --out ''", "--out: the name of the folder is empty" + see);
  CHECK(noether(folder, "stability --suite nowhere.toml").exit_code == 3);
}

// Verdicts hold on busy machines too.
const std::string patient = " --budget 1000";

TEST_CASE("stability --suite finds the scenes that noether brings, and every verdict right, the long ones too",
          "[cli][stability][nightly]") {
  const SceneFolder folder(spring);
  const std::string json = output(folder, "stability --suite --nightly --json" + patient);
  CHECK(is_json_line(json));
  CHECK(json_member(json, "verdicts") == json_member(json, "agreeing"));
  CHECK(std::stoi(json_member(json, "verdicts")) > 403);
}

}  // namespace
}  // namespace noether::test

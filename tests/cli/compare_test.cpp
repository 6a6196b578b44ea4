// `noether compare` and `noether advise`: files, exit codes, words.

#include "tests/cli/support.hpp"

#include <filesystem>
#include <string>

namespace noether::test {
namespace {

const std::string spring = R"(title = "A spring"
units = "reduced"
[particles]
body = [{ name = "ball", mass = 1, x = [1, 0, 0], v = [0, 0, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "harmonic_field"
k = 1
[integrator]
method = "verlet"
step = 0.05
steps = 400
)";

TEST_CASE("compare writes a table, its JSON and a report, and ends with 0 though rows have failed", "[cli][compare]") {
  const SceneFolder folder(spring);
  const std::string line = "compare scene.toml --methods verlet,rk4 --steps 3,0.1 --until 2000 --repeat 1";
  const std::string text = output(folder, line);
  CHECK(text.find("diverged") != std::string::npos);
  CHECK(text.starts_with("2 methods, 4 runs over 2000 "));
  CHECK(text.ends_with("wrote scene.out/compare.csv\nwrote scene.out/compare.json\nwrote scene.out/report.html\n"));
  CHECK(line_count(read_text(folder / "scene.out/compare.csv")) == 5);
  CHECK(is_json_line(read_text(folder / "scene.out/compare.json")));
  const std::string html = read_text(folder / "scene.out/report.html");
  CHECK(has(html, "noether compare scene.toml --methods 'verlet,rk4'"));
  const std::string json = output(folder, line + " --json --out elsewhere");
  CHECK(is_json_line(json));
  CHECK(has(json, "\"csv\":\"elsewhere/compare.csv\""));
  CHECK(has(json, "\"outcome\":\"diverged\""));
  CHECK(output(folder, line + " --quiet").empty());
  const std::string one = output(folder, "compare scene.toml --methods verlet --steps 0.1 --repeat 1e0");
  CHECK(one.starts_with("1 method, 1 run over "));
}

TEST_CASE("advise prints lines ready to paste", "[cli][advise]") {
  const SceneFolder folder(spring);
  const std::string text = output(folder, "advise scene.toml --error 1e-6 --methods verlet,blanes_moan_s6");
  INFO(text);
  CHECK(has(text, "--set 'integrator.method="));
  CHECK(has(text, "--set 'integrator.step="));
  const std::string json = output(folder, "advise scene.toml --error 1e-6 --metric energy --methods verlet --json");
  CHECK(is_json_line(json));
  CHECK(json_member(json, "method") == "\"verlet\"");
}

TEST_CASE("compare and advise begin at the minimum that a scene asks for", "[cli][compare][advise]") {
  // Downhill from 1, where one evaluation is not enough.
  const std::string minimum = "[minimize]\nmax_force = 1e-9\n";
  const SceneFolder rests(spring + minimum), lost(spring + minimum + "steps = 1\n");
  for (const std::string& command : {std::string("compare scene.toml --methods verlet --steps 0.1 --repeat 1"),
                                     std::string("advise scene.toml --error 1e-6 --methods verlet")}) {
    const ProcessResult found = noether(lost, command);
    INFO(command << found.out << found.err);
    CHECK(found.exit_code == 2);
    CHECK(has(found.err, "none is found"));
  }
  CHECK(has(output(rests, "compare scene.toml --methods verlet --steps 0.1 --repeat 1"), "1 method, 1 run"));
  CHECK_FALSE(output(rests, "advise scene.toml --error 1e-6 --methods verlet").empty());
}

TEST_CASE("wrong requests to compare and advise are told in one line", "[cli][compare][wrong]") {
  const SceneFolder folder(spring);
  const auto wrong = [&](const std::string& line, const std::string& message) {
    const ProcessResult result = noether(folder, line);
    INFO(line << "\n" << result.err);
    CHECK(result.exit_code == 2);
    CHECK(result.err == message + "\n");
    CHECK(result.out.empty());
  };
  const std::string see = "; see `noether compare --help`";
  wrong("compare scene.toml --methods verlet,dop85", "unknown method 'dop85'; did you mean 'dop853'?");
  wrong("compare scene.toml --methods ''", "--methods '': a part of the list is empty");
  wrong("compare scene.toml --methods verlet,,rk4", "--methods 'verlet,,rk4': a part of the list is empty");
  wrong("compare scene.toml --steps soon",
        "--steps: 'soon' does not begin with a number; a time is expected, such as '1'");
  wrong("compare scene.toml --steps 0.1,-1", "--steps '-1' is not a time above 0");
  wrong("compare scene.toml --methods verlet --steps 1e-200",
        "a run of 20 has more steps of 1e-200 than can be counted; give steps of at least 2.4e-15");
  wrong("compare scene.toml --tolerances 1e-6,x", "--tolerances: 'x' is not a number");
  wrong("compare scene.toml --methods dop853 --tolerances 1e-8,1e-20",
        "rtol = 1e-20 is below the rounding of doubles; at least 9e-16 is expected, or a method that solves to "
        "rounding, such as 'gauss_8'");
  wrong("compare scene.toml --tolerances 0", "0 is not a valid tolerance; a number between 0 and 1 is expected");
  wrong("compare scene.toml --methods dop853,gauss_8 --steps 0.1",
        "--steps is for methods of fixed steps, but all the methods compared choose theirs by a tolerance; leave it "
        "out, or add such a method, such as 'rk4'");
  wrong("compare scene.toml --methods verlet,rk4 --tolerances 1e-6",
        "--tolerances is for methods that choose their steps, but all the methods compared take fixed ones; leave it "
        "out, or add such a method, such as 'dop853'");
  wrong("compare scene.toml --repeat 2000000", "--repeat: '2000000' is more than 1000000" + see);
  wrong("compare scene.toml --repeat 1.5", "--repeat: '1.5' is not a whole number above 0" + see);
  wrong("compare scene.toml --repeat 0", "--repeat: '0' is not a whole number above 0" + see);
  wrong("compare scene.toml --budget -1", "--budget: '-1' is not a number of seconds above 0" + see);
  wrong("compare scene.toml --until 0", "--until '0' is not a time above 0");
  wrong("compare scene.toml --out ''", "--out: the name of the folder is empty" + see);
  wrong("advise scene.toml", "--error is required; see `noether advise --help`");
  wrong("advise scene.toml --error 0", "an error of 0 cannot be held; a number between 0 and 1 is expected");
  wrong("advise scene.toml --error -1e-3", "an error of -0.001 cannot be held; a number between 0 and 1 is expected");
  wrong("advise scene.toml --error small", "--error: 'small' is not a number");
  wrong("advise scene.toml --error 1e-3 --metric engery", "--metric: unknown metric 'engery'; did you mean 'energy'?");
}

TEST_CASE("a folder that cannot be made is exit 3", "[cli][compare]") {
  const SceneFolder folder(spring);
  const ProcessResult result =
      noether(folder, "compare scene.toml --methods verlet --steps 0.1 --repeat 1 --out scene.toml/out");
  CHECK(result.exit_code == 3);
  CHECK(result.err.starts_with("scene.toml/out: "));
}

}  // namespace
}  // namespace noether::test

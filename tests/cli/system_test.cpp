// The program on scenes of first-order systems.

#include "tests/cli/support.hpp"

#include <cmath>
#include <string>

namespace noether::test {
namespace {

const std::string kinetics = R"(title = "Kinetics"
units = "reduced"
[system]
type = "robertson"
[integrator]
method = "rk4"
step = 1e-4
steps = 100
[[every]]
type = "variables"
variable = "B"
steps = 10
)";
const std::string written = kinetics + R"([[every]]
type = "trajectory"
steps = 20
[[every]]
type = "checkpoint"
steps = 40
)";

TEST_CASE("explain tells in plain words how stiff a system is", "[cli][explain][system]") {
  const SceneFolder folder(kinetics);
  const std::string text = output(folder, "explain scene.toml --set integrator.steps=1000000000000");
  for (const char* line :
       {"Kinetics: rk4 over robertson, 3 variables\n", "\n  system robertson\n",
        "\n  4 evaluations of all rates, on the average of the first steps\n",
        "\nstiffness: stiff: S = 1e+12; an explicit method needs about 3.6e+11 steps; use rodas_5p or bdf\n",
        " of a rough run to t = 1e+08\n  fastest rate 1e+04, at t = 1e+08; at the start 0.04\n"}) {
    INFO(line << "\n" << text);
    CHECK(has(text, line));
  }
  CHECK_FALSE(has(text, "force gravity"));
  const std::string json = output(folder, "explain scene.toml --json");
  CHECK(json_member(json, "variables") == "3");
  CHECK(std::abs(std::stod(json_member(json, "fastest")) - 0.04) < 1e-15);
  CHECK(std::abs(std::stod(json_member(json, "S")) - 0.0004) < 1e-15);
  CHECK(has(json,
            "\"verdict\":\"not stiff: S = 20.5; an explicit method such as dop853 is enough\",\"along\":{\"S\":20."));
}

TEST_CASE("list and describe know systems, and evaluate says that they have no forces", "[cli][system]") {
  const SceneFolder folder(kinetics);
  const std::string list = output(folder, "list systems");
  for (const char* name :
       {"robertson", "rc_ladder", "heat_line", "lorenz", "prothero_robinson", "forced_damped_oscillator"}) {
    CHECK(has(list, std::string("\n") + name + " "));
    const std::string text = output(folder, std::string("describe ") + name);
    CHECK(text.starts_with(std::string(name) + " (system): "));
    CHECK(has(text, "\n  belongs in [system]"));
    CHECK(has(text, "\n@"));
  }
  const ProcessResult result = noether(folder, "evaluate scene.toml --forces forces.csv");
  CHECK(result.exit_code == 2);
  CHECK(result.err ==
        "scene.toml: there is nothing to evaluate: system 'robertson' has neither energy nor forces; `noether explain` "
        "shows how stiff it is\n");
}

#if NOETHER_HDF5

TEST_CASE("a system's run reports no particles, and its digest is that of its files", "[cli][run][system]") {
  const SceneFolder folder(written);
  const ProcessResult result = noether(folder, "run scene.toml --json");
  CHECK(result.exit_code == 0);
  CHECK(json_member(result.out, "particles") == "0");
  CHECK(json_member(result.out, "step") == "100");
  CHECK(has(result.out, "\"variables\":{\"first\":0"));
  const std::string digest = json_member(result.out, "digest");
  for (const char* file : {"scene.out/run.h5", "scene.out/checkpoint.h5"}) {
    const std::string info = output(folder, std::string("info --json ") + file);
    CHECK(json_member(info, "digest") == digest);
    CHECK(json_member(info, "variables") == "3");
    CHECK(json_member(output(folder, std::string("verify --json ") + file), "ok") == "true");
  }
  CHECK(has(output(folder, "info scene.out/run.h5"), "  3 variables, step 100, time 0.01\n"));
  output(folder, "convert scene.out/run.h5 run.csv");
  CHECK(read_text(folder / "run.csv").starts_with("step,time,A,B,C\n0,0,1,0,0\n20,"));
  CHECK(noether(folder, "convert scene.out/run.h5 run.xyz").exit_code == 2);
}

TEST_CASE("a system's run that was killed goes on as one that was not", "[cli][resume][system]") {
  const SceneFolder folder(written), other(written);
  CHECK(noether(folder, "run scene.toml --quiet").exit_code == 0);
  make_unfinished(folder / "scene.out");
  const ProcessResult again = noether(folder, "run scene.toml --json --resume");
  CHECK(again.exit_code == 0);
  CHECK(json_member(again.out, "resumed_from_step") == "80");
  check_same_run(again.out, noether(other, "run scene.toml --json").out);
  check_same_content(folder / "scene.out/run.h5", other / "scene.out/run.h5");
  const ProcessResult changed = noether(folder, "run scene.toml --resume --until 0.02 --set system.k1=0.05");
  CHECK(changed.exit_code == 2);
  CHECK(changed.err ==
        "--set system.k1=0.05: system.k1 = 0.05 was 0.04; a resumed run may change only its end, to a later one: undo "
        "this, or start over with --fresh\n");
}

TEST_CASE("a system that leaves all bounds ends with the variable's name", "[cli][run][system]") {
  const SceneFolder folder(written);
  const ProcessResult result = noether(folder, "run scene.toml --json --set integrator.step=1e3");
  CHECK(result.exit_code == 1);
  CHECK(json_member(result.out, "outcome") == "\"diverged\"");
  CHECK(json_member(result.out, "particle") == "null");
  CHECK(json_member(result.out, "quantity").starts_with("\"y["));
  CHECK(has(result.out, "is not finite"));
}

#endif

}  // namespace
}  // namespace noether::test

// Ends and cadences between two steps: whole steps are taken and noted, in every command that reads a scene.

#include "tests/cli/support.hpp"

#include <string>
#include <vector>

namespace noether::test {
namespace {

/// Two bodies in days: an end and cadences that are no whole numbers of steps.
const std::string between_steps = R"(title = "Between steps"
units = "solar"
[[particles.body]]
name = "Sun"
mass = "1 Msun"
x = ["0 au", "0 au", "0 au"]
v = ["0 au/day", "0 au/day", "0 au/day"]
[[particles.body]]
name = "Earth"
mass = "3e-6 Msun"
x = ["1 au", "0 au", "0 au"]
v = ["0 au/day", "0.0172 au/day", "0 au/day"]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "gravity"
[integrator]
method = "verlet"
step = "1 day"
until = "1 yr"
[[every]]
type = "energy"
every = "10.4 day"
[[stop]]
type = "escape"
distance = "50 au"
every = "2 hour"
)";

const std::string until_note =
    "note: scene.toml:20: until = \"1 yr\" is 365.25 steps of \"1 day\"; the run ends at the first whole step after "
    "it, "
    "\"366 day\" (366 steps)\n";
const std::string every_note =
    "note: scene.toml:23: every = \"10.4 day\" is 10.4 steps of \"1 day\"; the nearest whole number of steps is taken, "
    "\"10 day\" (10 steps)\n";
TEST_CASE("a run whose end lies between two steps ends at the later one, and says so", "[cli][run][messages]") {
  const SceneFolder folder(between_steps);
  const ProcessResult result = noether(folder, "run scene.toml --json");
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK(result.err.starts_with(until_note + every_note + "note: scene.toml:27: every = \"2 hour\" is 0.08333"));
  CHECK(line_count(result.err) == 3);
  CHECK(json_member(result.out, "step") == "366");
  CHECK(json_member(json_member(result.out, "energy"), "samples") == "37");
  CHECK(has(result.out, "\"notes\":[\"scene.toml:20: until = "));
  const ProcessResult whole = noether(folder,
                                      "run scene.toml --json --out b --set integrator.until='366 day' "
                                      "--set every.0.every='10 day' --set stop.0.every='1 day'");
  CHECK(whole.err.empty());
  CHECK_FALSE(has(whole.out, "\"notes\""));
  CHECK(json_member(whole.out, "digest") == json_member(result.out, "digest"));
  CHECK(noether(folder, "run scene.toml --quiet --out c").err.empty());
}

TEST_CASE("every command that reads a scene takes whole steps, and notes each once", "[cli][messages]") {
  const SceneFolder folder(between_steps);
  for (const char* line :
       {"explain scene.toml", "evaluate scene.toml", "evaluate scene.toml --json",
        "compare scene.toml --methods verlet,yoshida_4 --steps '1 day,0.5 day' --repeat 1 --quiet --json",
        "stability scene.toml --methods verlet --steps 1000 --budget 1",
        "advise scene.toml --error 1e-2 --methods verlet --budget 1"}) {
    INFO(line);
    const bool both = std::string(line).ends_with("--quiet --json");
    const std::string command = both ? replaced(line, " --quiet", "") : std::string(line);
    const ProcessResult result = noether(folder, command);
    INFO(result.err);
    CHECK(result.exit_code == 0);
    CHECK(line_count(result.err) == 3);
    CHECK(result.err.starts_with(until_note + every_note));
  }
}

TEST_CASE("--until and backward runs take whole steps, and exact refuses", "[cli][run][messages]") {
  const SceneFolder folder(unwritten);
  const ProcessResult later = noether(folder, "run scene.toml --json --until 0.505");
  CHECK(json_member(later.out, "step") == "51");
  CHECK(later.err ==
        "note: --until 0.505: until = \"0.505\" is 50.5 steps of 0.01; the run ends at the first whole step after it, "
        "0.51 (51 steps)\n");
  const ProcessResult back =
      noether(folder, "run scene.toml --json --out b --set integrator.step=-0.01 --until -0.505");
  CHECK(json_member(back.out, "step") == "51");
  CHECK(json_member(back.out, "time") == "-0.51");
  const ProcessResult shifted =
      noether(folder, "run scene.toml --json --out c --set integrator.start_time=5 --until 5.001");
  CHECK(json_member(shifted.out, "step") == "1");
  CHECK(has(shifted.err,
            "until = \"5.001\" is 0.1 steps of 0.01 after 5; the run ends at the first whole step after "
            "it, 5.01 (1 step)"));
  const ProcessResult refused = noether(folder, "run scene.toml --set integrator.exact=true --until 0.505");
  CHECK(refused.exit_code == 2);
  CHECK(has(refused.err, "the nearest whole numbers are 0.5 (50 steps) and 0.51 (51 steps)"));
  CHECK(noether(folder, "run scene.toml --quiet --out d --set integrator.exact=true --until 0.5").exit_code == 0);
}

TEST_CASE("times of a list between steps go to the nearest, those that meet there once", "[cli][run][messages]") {
  const SceneFolder folder(replaced(unwritten, "steps = 10\n", "times = [0, 0.101, 0.104, 0.106, 0.2]\n"));
  const ProcessResult result = noether(folder, "run scene.toml --json");
  CHECK(result.exit_code == 0);
  CHECK(json_member(json_member(result.out, "energy"), "samples") == "4");  // 0, 0.1, 0.11, 0.2
  CHECK(has(result.err,
            ": 3 of 5 times lie between steps of 0.01; the nearest whole steps are taken, and 1 is left out "
            "where two come to one step\n"));
  const ProcessResult refused = noether(folder, "run scene.toml --set integrator.exact=true");
  CHECK(refused.exit_code == 2);
  CHECK(has(refused.err, "times contains 0.101, which is 10.1 steps of 0.01"));
}

TEST_CASE("methods with dense output are shown at times between steps as they are", "[cli][run][messages]") {
  const SceneFolder folder(between_steps);
  const std::string run = "run scene.toml --json --set integrator.method=encke_gauss_8 ";
  const ProcessResult result = noether(folder, run);
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK(line_count(result.err) == 2);  // the end and the stop are at whole steps
  CHECK(result.err.starts_with(until_note + "note: scene.toml:27: every = \"2 hour\" is 0.08333"));
  CHECK(json_member(result.out, "step") == "366");
  CHECK(json_member(json_member(result.out, "energy"), "samples") == "36");  // 0, 10.4, ..., 364 days
  const std::string whole = "--set integrator.until='366 day' --set stop.0.every='1 day' --set integrator.exact=true";
  const ProcessResult bare = noether(folder, run + "--out b " + whole + " --set every.0.every='61 day'");
  CHECK(bare.err.empty());
  CHECK(json_member(bare.out, "digest") == json_member(result.out, "digest"));
  CHECK(noether(folder, run + "--out c " + whole).exit_code == 0);
  const SceneFolder listed(replaced(between_steps, "every = \"10.4 day\"",
                                    "times = [\"0 day\", \"10.4 day\", \"11 day\", \"365.9 day\", \"366.1 day\"]"));
  const ProcessResult list = noether(listed, run);
  INFO(list.err);
  CHECK(json_member(json_member(list.out, "energy"), "samples") == "4");
  const ProcessResult told = noether(listed, "run scene.toml --out b --set integrator.method=encke_gauss_8");
  CHECK(has(told.out + told.err, "1 of 5 times of 'energy' lies after the end at 366 day"));
}

#if NOETHER_HDF5

TEST_CASE("frames between steps are those of an unbroken run", "[cli][resume]") {
  const std::string scene = between_steps + "[[every]]\ntype = \"trajectory\"\nevery = \"0.7 day\"\n";
  const SceneFolder folder(scene), other(scene);
  const std::string method = " --set integrator.method=encke_gauss_8";
  CHECK(noether(folder, "run scene.toml --quiet --until '100.5 day'" + method).exit_code == 0);
  const ProcessResult longer = noether(folder, "run scene.toml --json --resume --until '200 day'" + method);
  INFO(longer.err);
  CHECK(longer.exit_code == 0);
  CHECK(json_member(longer.out, "resumed_from_step") == "101");
  check_same_run(longer.out, noether(other, "run scene.toml --json --until '200 day'" + method).out);
  check_same_content(folder / "scene.out/run.h5", other / "scene.out/run.h5");
  CHECK(noether(folder, "verify scene.out/run.h5").exit_code == 0);
}

TEST_CASE("a run that ended between two steps goes on, to the same later end as one long run", "[cli][resume]") {
  const SceneFolder folder, other;
  CHECK(noether(folder, "run scene.toml --quiet --until 0.505").exit_code == 0);
  const ProcessResult longer = noether(folder, "run scene.toml --json --resume --until 1.505");
  CHECK(longer.exit_code == 0);
  CHECK(json_member(longer.out, "resumed_from_step") == "51");
  check_same_run(longer.out, noether(other, "run scene.toml --json --until 1.505").out);
  check_same_content(folder / "scene.out/run.h5", other / "scene.out/run.h5");
  CHECK(noether(folder, "verify scene.out/run.h5").exit_code == 0);
}

#endif

}  // namespace
}  // namespace noether::test

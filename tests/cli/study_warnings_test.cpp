// What compare, advise and stability say of a scene before they answer: what `run` says of it, each once.

#include "tests/cli/support.hpp"

#include <string>
#include <vector>

namespace noether::test {
namespace {

const std::string wary_spring = R"(units = "reduced"
[particles]
body = [{ name = "ball", mass = 1, x = [1, 0, 0], v = [0, 0.5, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "harmonic_field"
k = 1
[integrator]
method = "verlet"
step = 0.05
steps = 400
[[every]]
type = "energy"
times = [1, 30]
[expect]
enrgy.worst = 1
[[verdict]]
outcome = "bounde"
)";

const std::vector<std::string> wary_lines = {
    "warning: scene.toml:17: [expect] names 'enrgy', which is not a monitor of this scene; did you mean 'energy'?",
    "warning: scene.toml:19: unknown outcome 'bounde'; did you mean 'bounded'?",
    "warning: 1 of 2 times of 'energy' lies after the end at 20, so it does not sample then"};

const std::string compare_line = "compare scene.toml --methods verlet --steps 0.05 --repeat 1";

TEST_CASE("compare, advise and stability warn of a scene as run does, each warning once and on stderr",
          "[cli][compare][advise][stability]") {
  const SceneFolder folder(wary_spring);
  const ProcessResult run = noether(folder, "run scene.toml --quiet");
  CHECK(run.exit_code == 0);  // neither ends a run
  CHECK(run.err.empty());
  const std::string report = noether(folder, "run scene.toml").out;
  for (const std::string& line : wary_lines) CHECK(has(report, line + "\n"));
  for (const std::string& command : {compare_line, std::string("advise scene.toml --error 1e-3 --methods verlet"),
                                     std::string("stability scene.toml --methods verlet --steps 2000")}) {
    for (const char* json : {"", " --json"}) {
      const ProcessResult answer = noether(folder, command + json);
      INFO(command << json << "\n" << answer.err);
      CHECK(answer.exit_code == 0);
      CHECK(lines_of(answer.err) == wary_lines);
      CHECK_FALSE(has(answer.out, "warning: "));
      CHECK(is_json_line(answer.out) == (*json != '\0'));
    }
  }
  CHECK(noether(folder, compare_line + " --quiet").err.empty());
}

TEST_CASE("stability --suite refuses a wrong verdict, which is what it judges by", "[cli][stability]") {
  const SceneFolder folder(wary_spring);
  const ProcessResult refused = noether(folder, "stability --suite scene.toml");
  CHECK(refused.exit_code == 2);
  CHECK(refused.err == "scene.toml:19: unknown outcome 'bounde'; did you mean 'bounded'?\n");
  CHECK(refused.out.empty());
}

TEST_CASE("advise --until asks about a run to another end, by the clock", "[cli][advise]") {
  const SceneFolder folder(wary_spring.substr(0, wary_spring.find("[[every]]")));
  const std::string line = "advise scene.toml --error 1e-3 --methods verlet --json --set integrator.start_time=10";
  CHECK(json_member(output(folder, line), "end") == "20");
  CHECK(json_member(output(folder, line + " --until 40"), "end") == "30");
  CHECK(noether(folder, line + " --until ''").exit_code == 2);
}

#if NOETHER_HDF5

TEST_CASE("a run goes on with other verdicts", "[cli][resume]") {
  const SceneFolder folder(wary_spring);
  CHECK(noether(folder, "run scene.toml --quiet").exit_code == 0);
  write_text(folder / "scene.toml", replaced(wary_spring, "\"bounde\"", "\"bounded\""));
  const ProcessResult resumed = noether(folder, "run scene.toml --resume --json --set integrator.steps=600");
  INFO(resumed.err);
  CHECK(resumed.exit_code == 0);
  CHECK(json_member(resumed.out, "step") == "600");
}

#endif

}  // namespace
}  // namespace noether::test

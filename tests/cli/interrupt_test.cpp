// Runs that are stopped and go on: the same digest, figures and datasets as if nothing had happened.

#include "tests/cli/support.hpp"

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace noether::test {
namespace {

namespace fs = std::filesystem;

#if NOETHER_HDF5

/// Three bodies, long enough to be caught on the way: everything is watched, no two cadences are in step.
std::string long_scene(const std::string& hamiltonian, const std::string& method) {
  return R"(units = "reduced"
[[particles.body]]
name = "star"
mass = 1
x = [0, 0, 0]
v = [0, 0, 0]
[[particles.body]]
name = "inner"
mass = 0.001
x = [1, 0, 0]
v = [0, 1, 0.1]
[[particles.body]]
name = "outer"
mass = 0.0005
x = [0, 2.5, 0]
v = [-0.6, 0, 0]
[hamiltonian]
)" + hamiltonian +
         "[integrator]\nmethod = \"" + method + R"("
step = 0.01
steps = 20000
[[every]]
type = "energy"
steps = 10
[[every]]
type = "angular_momentum"
steps = 7
[[every]]
type = "elements"
steps = 100
[[every]]
type = "closest_approach"
steps = 3
[[every]]
type = "trajectory"
steps = 30
[[every]]
type = "checkpoint"
steps = 2600
)";
}

const std::string fourth_order =
    long_scene("type = \"kinetic_potential\"\n[[hamiltonian.force]]\ntype = \"gravity\"\n", "yoshida_4");
const std::string kepler_arcs = long_scene("type = \"wisdom_holman\"\n", "aba_10_6_4");

/// The run of a scene that nobody interrupts, made once: its report, its files in `folder`.
struct WholeRun {
  explicit WholeRun(const std::string& scene) : folder(scene), json(noether(folder, "run scene.toml --json").out) {}
  SceneFolder folder;
  std::string json;
};
const WholeRun& whole_run(const std::string& scene) {
  static std::map<std::string, std::unique_ptr<WholeRun>> made;
  auto& run = made[scene];
  if (!run) run = std::make_unique<WholeRun>(scene);
  return *run;
}

/// Starts a run and sends it a signal as soon as it has written a checkpoint, which is far from its end.
ProcessResult stop_midway(const SceneFolder& folder, const std::string& line, int signal) {
  const fs::path checkpoint = folder / "scene.out/checkpoint.h5";
  std::error_code none;
  const auto before = fs::last_write_time(checkpoint, none);
  Process process(command(line), folder.path());
  CHECK(wait_until([&] { return fs::exists(checkpoint) && fs::last_write_time(checkpoint, none) != before; }));
  process.signal(signal);
  return process.wait();
}

/// Step of an interrupted run, from its report.
std::string check_interrupted(const ProcessResult& result) {
  INFO(result.out << result.err);
  CHECK(result.exit_code == 130);
  CHECK(result.err.empty());
  REQUIRE(is_json_line(result.out));
  CHECK(json_member(result.out, "outcome") == "\"interrupted\"");
  CHECK(json_member(result.out, "exit_code") == "130");
  return json_member(result.out, "step");
}

void check_interrupt_and_resume(const std::string& scene, int signal) {
  const SceneFolder folder(scene);
  const std::string step = check_interrupted(stop_midway(folder, "run scene.toml --json", signal));
  const std::string info = noether(folder, "info scene.out/checkpoint.h5 --json").out;
  CHECK(json_member(info, "last_step") == step);
  CHECK(json_member(info, "outcome") == "null");
  const ProcessResult resumed = noether(folder, "run scene.toml --json --resume");
  CHECK(resumed.exit_code == 0);
  CHECK(json_member(resumed.out, "resumed_from_step") == step);
  check_same_run(resumed.out, whole_run(scene).json);
  check_same_content(folder / "scene.out/run.h5", whole_run(scene).folder / "scene.out/run.h5");
}

TEST_CASE("SIGINT ends a fourth-order run with a checkpoint; it resumes as if nothing had happened",
          "[cli][resume][slow]") {
  check_interrupt_and_resume(fourth_order, SIGINT);
}

TEST_CASE("SIGTERM ends a Wisdom-Holman run with a checkpoint; it resumes as if nothing had happened",
          "[cli][resume][slow]") {
  check_interrupt_and_resume(kepler_arcs, SIGTERM);
}

TEST_CASE("an interrupted run says with which command it goes on", "[cli][resume][slow]") {
  const SceneFolder folder(fourth_order);
  const ProcessResult result =
      stop_midway(folder, "run scene.toml --fresh --threads 1 --set 'title=Do not stop'", SIGINT);
  CHECK(result.exit_code == 130);
  CHECK(result.out.starts_with("interrupted at step "));
  const std::string command =
      std::string(NOETHER_PROGRAM) + " run scene.toml --threads 1 --set 'title=Do not stop' --resume";
  REQUIRE(result.err == "to continue: " + command + "\n");
  const ProcessResult resumed = run_process({"/bin/sh", "-c", command}, folder.path());
  CHECK(resumed.exit_code == 0);
  CHECK(has(resumed.out, "\nresumed from step "));
}

TEST_CASE("under the launcher of a checkout the command is the launcher's, by the shorter of its paths",
          "[cli][resume][slow]") {
  const SceneFolder folder(fourth_order);
  const auto told = [&](const std::string& launcher) {
    ::setenv("NOETHER_LAUNCHER", launcher.c_str(), 1);
    const ProcessResult result = stop_midway(folder, "run scene.toml --fresh", SIGINT);
    ::unsetenv("NOETHER_LAUNCHER");
    return result.err;
  };
  CHECK(told((folder / "noether").string()) == "to continue: ./noether run scene.toml --resume\n");
  CHECK(told((folder / "a b/noether").string()) == "to continue: 'a b/noether' run scene.toml --resume\n");
  CHECK(told("/n") == "to continue: /n run scene.toml --resume\n");
}

TEST_CASE("a run that is interrupted twice resumes twice", "[cli][resume][slow]") {
  const SceneFolder folder(fourth_order);
  const std::string first = check_interrupted(stop_midway(folder, "run scene.toml --json", SIGINT));
  const ProcessResult again = stop_midway(folder, "run scene.toml --json --resume", SIGINT);
  const std::string second = check_interrupted(again);
  CHECK(json_member(again.out, "resumed_from_step") == first);
  const ProcessResult last = noether(folder, "run scene.toml --json --resume");
  CHECK(json_member(last.out, "resumed_from_step") == second);
  CHECK(std::stol(first) < std::stol(second));
  check_same_run(last.out, whole_run(fourth_order).json);
  check_same_content(folder / "scene.out/run.h5", whole_run(fourth_order).folder / "scene.out/run.h5");
}

TEST_CASE("a run killed by SIGKILL resumes from its newest checkpoint", "[cli][resume][slow]") {
  for (const std::string& scene : {fourth_order, kepler_arcs}) {
    const SceneFolder folder(scene);
    CHECK(stop_midway(folder, "run scene.toml --json", SIGKILL).exit_code == 128 + SIGKILL);
    const ProcessResult resumed = noether(folder, "run scene.toml --json --resume");
    INFO(resumed.out << resumed.err);
    CHECK(resumed.exit_code == 0);
    CHECK(std::stol(json_member(resumed.out, "resumed_from_step")) % 2600 == 0);
    check_same_run(resumed.out, whole_run(scene).json);
    check_same_content(folder / "scene.out/run.h5", whole_run(scene).folder / "scene.out/run.h5");
  }
}

TEST_CASE("a second SIGINT stops at once, without a report", "[cli][resume][slow]") {
  // Each step takes long: 14 sums over 32 million pairs.
  std::string bodies = "name,mass,x,y,z,vx,vy,vz\n";
  for (int k = 0; k < 8000; ++k) bodies += fmt::format("b{0},1e-3,{0},0,0,0,0,0\n", k);
  const SceneFolder folder(R"(units = "reduced"
[particles]
bodies = "bodies.csv"
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "gravity"
[integrator]
method = "srkn14a"
step = 1e-3
steps = 1000000
[[every]]
type = "checkpoint"
steps = 1
)");
  write_text(folder / "bodies.csv", bodies);
  const fs::path checkpoint = folder / "scene.out/checkpoint.h5";
  Process process(command("run scene.toml --json --threads 1"), folder.path());
  REQUIRE(wait_until([&] { return fs::exists(checkpoint); }));
  std::this_thread::sleep_for(std::chrono::milliseconds(150));  // by now the next step is under way
  process.signal(SIGINT);
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  process.signal(SIGINT);
  const ProcessResult result = process.wait();
  CHECK(result.exit_code == 128 + SIGINT);
  CHECK((result.out + result.err).empty());
  CHECK(noether(folder, "info scene.out/checkpoint.h5").exit_code == 0);
}

#else

TEST_CASE("without HDF5 an interrupted run exits 130 and names no checkpoint", "[cli][resume]") {
  const SceneFolder folder(two_bodies.substr(0, two_bodies.find("[[every]]")));
  Process process(command("run scene.toml --json --set integrator.steps=1000000000"), folder.path());
  std::this_thread::sleep_for(std::chrono::seconds(1));  // nothing tells that the first step is made
  process.signal(SIGINT);
  const ProcessResult result = process.wait();
  CHECK(result.exit_code == 130);
  CHECK(json_member(result.out, "outcome") == "\"interrupted\"");
  CHECK(json_member(result.out, "files") == R"({"trajectory":null,"checkpoint":null})");
}

#endif

}  // namespace
}  // namespace noether::test

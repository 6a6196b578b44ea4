// kill -9 at any moment, from the first to the last of a run: --resume ends as a run that nobody has killed.

#include "io/checkpoint.hpp"
#include "io/inspect.hpp"
#include "tests/cli/support.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <random>
#include <string>
#include <thread>

#if NOETHER_HDF5

namespace noether::test {
namespace {

namespace fs = std::filesystem;

/// Frames every 20 steps, checkpoints every 40.
const std::string small_run = two_bodies.substr(0, two_bodies.find("steps = 100")) + "steps = 2000\n" +
                              two_bodies.substr(two_bodies.find("[[every]]"));

/// The same by a method with a past, every step brought back to its energy and angular momentum.
std::string projected_run() {
  return two_bodies.substr(0, two_bodies.find("[integrator]")) + R"([integrator]
method = "adams_bashforth_4"
step = 0.01
steps = 2000
[integrator.projection]
onto = ["energy", "angular_momentum"]
)" + two_bodies.substr(two_bodies.find("[[every]]"));
}

/// 20 000 tracers around two bodies; frames and checkpoints take longer than the steps between.
const std::string large_run = R"(units = "reduced"
[particles]
bodies = "bodies.csv"
[hamiltonian]
type = "wisdom_holman"
[integrator]
method = "aba_10_6_4"
step = 0.01
steps = 12
[[every]]
type = "energy"
steps = 2
[[every]]
type = "trajectory"
steps = 2
[[every]]
type = "checkpoint"
steps = 3
)";

/// Lorenz's system, which magnifies any other bit; frames every 20 steps.
const std::string chaotic_system = R"(units = "reduced"
[system]
type = "lorenz"
[integrator]
method = "rk4"
step = 0.01
steps = 4000
[[every]]
type = "variables"
variable = "z"
steps = 7
[[every]]
type = "trajectory"
steps = 20
[[every]]
type = "checkpoint"
steps = 40
)";

/// Stiff kinetics by a method with a past and steps of its own; a frame every 0.5.
const std::string stiff_system = R"(units = "reduced"
[system]
type = "robertson"
[integrator]
method = "bdf"
rtol = 1e-8
until = 100
[[every]]
type = "variables"
variable = "B"
every = 0.25
[[every]]
type = "trajectory"
every = 0.5
[[every]]
type = "checkpoint"
steps = 20
)";

/// Watchers of a run of 4000 steps: frames every 20 steps, checkpoints every 40.
const std::string watchers = R"([[every]]
type = "energy"
steps = 7
[[every]]
type = "trajectory"
steps = 20
[[every]]
type = "checkpoint"
steps = 40
)";

/// A heavy top on its group.
const std::string top_run = R"(units = "reduced"
[[particles.rigid_body]]
name = "top"
mass = 1
inertia = [2, 1, 0.75]
fixed_point = [0, 0, 0]
center = [0.2, 0.3, 0.5]
spin = [0.6, -0.4, 0.9]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "uniform_field"
acceleration = [0, 0, -1]
[integrator]
method = "rkmk_rk4"
step = 0.05
steps = 4000
)" + watchers;

/// A double pendulum by its action, which magnifies any other bit; its shadow has a past.
const std::string action_run = R"(units = "reduced"
[system]
type = "double_pendulum"
[integrator]
method = "galerkin_gauss_2"
step = 0.01
steps = 4000
[[every]]
type = "shadow_hamiltonian"
steps = 1
)" + watchers;

/// A block that tumbles, exact in its energy.
const std::string block_run = R"(units = "reduced"
[particles]
type = "block"
cells = [2, 2, 2]
size = [1, 1, 1]
density = 1
stretch = [1.2, 0.9, 1.05]
angular_velocity = [1, 0.3, 2]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "hyperelastic"
lambda = 1
mu = 0.8
[integrator]
method = "simo_tarnow_wong"
step = 0.1
steps = 400
)" + watchers;

/// Two bodies by a method with steps of its own, from another time than 0; frames and samples at times of lists.
std::string listed_run() {
  std::string frames, samples;
  for (int k = 1; k <= 300; ++k) frames += fmt::format("{}{}", k == 1 ? "" : ", ", 1000 + 0.4 * k + 0.1 * (k % 3));
  for (int k = 0; k <= 500; ++k) samples += fmt::format("{}{}", k == 0 ? "" : ", ", 1010 + 0.2 * k);
  return two_bodies.substr(0, two_bodies.find("[integrator]")) + R"([integrator]
method = "dop853"
rtol = 1e-10
start_time = 1000
until = 1120
[[every]]
type = "energy"
times = [)" +
         samples + "]\n[[every]]\ntype = \"trajectory\"\ntimes = [" + frames +
         "]\n[[every]]\ntype = \"checkpoint\"\nsteps = 20\n";
}

std::string tracers() {
  std::string bodies = "name,mass,x,y,z,vx,vy,vz\nstar,1,0,0,0,0,0,0\nplanet,0.001,1,0,0,0,1,0\n";
  for (int k = 0; k < 20'000; ++k) {
    const double r = 2 + k * 1e-4;
    bodies += fmt::format("t{},0,{},0,0,0,{},0\n", k, r, 1 / std::sqrt(r));
  }
  return bodies;
}

/// Frames that a checkpoint counts on: due at the steps before it, or, of a cadence in time, those it has seen.
std::int64_t frames_counted_on(const io::Checkpoint& checkpoint, std::int64_t steps_between_frames) {
  if (steps_between_frames > 0) return checkpoint.step / steps_between_frames + 1;
  std::int64_t seen = 0;
  load_value(checkpoint.run.parts.at("trajectory"), "observed", seen);
  return seen;
}

/// What a killed run has left can be read, and has every frame that its newest checkpoint counts on.
void check_left(const fs::path& out, std::int64_t steps_between_frames) {
  const io::FoundCheckpoint found = io::newest_checkpoint(out);
  CHECK(found.damaged.empty());
  const std::int64_t least = found.checkpoint ? frames_counted_on(*found.checkpoint, steps_between_frames) : 0;
  if (least == 0 && !fs::exists(out / "run.h5")) return;
  const io::FileInfo info = io::verify(out / "run.h5");
  CHECK(info.damaged == std::vector<std::string>{});
  CHECK(info.frames >= least);
}

/// Kills a run again and again until it comes through, then begins anew, until there were so many deaths.
/// @param steps_between_frames  0 where they come by time
void die_at_moments(const std::string& scene, std::int64_t steps_between_frames, int deaths) {
  using Clock = std::chrono::steady_clock;
  const SceneFolder whole(scene), folder(scene);
  for (const SceneFolder* one : {&whole, &folder}) write_text(*one / "bodies.csv", tracers());
  const Clock::time_point begin = Clock::now();
  const std::string json = noether(whole, "run scene.toml --json --threads 1").out;
  const auto takes = std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - begin).count();
  std::mt19937 random(20261122);
  std::uniform_int_distribution<std::int64_t> moment(0, takes + takes / 10);
  for (int left = deaths, ends = 0; left > 0 || ends == 0;) {
    CAPTURE(left);
    Process process(command("run scene.toml --json --threads 1 --resume"), folder.path());
    if (left > 0) {
      std::this_thread::sleep_for(std::chrono::microseconds(moment(random)));
      process.signal(SIGKILL);
    }
    const ProcessResult result = process.wait();
    if (result.exit_code == 128 + SIGKILL) {
      --left;
      check_left(folder / "scene.out", steps_between_frames);
      continue;
    }
    ++ends;
    INFO(result.err);
    CHECK(result.exit_code == 0);
    check_same_run(result.out, json);
    check_same_content(folder / "scene.out/run.h5", whole / "scene.out/run.h5");
    fs::remove_all(folder / "scene.out");
  }
}

TEST_CASE("a run killed at moments from start to end ends, resumed, as one never killed", "[cli][resume][kill][slow]") {
  die_at_moments(small_run, 20, 12);
  die_at_moments(large_run, 2, 6);
}

TEST_CASE("a system's run killed at moments from start to end ends, resumed, as one never killed",
          "[cli][resume][kill][system][slow]") {
  die_at_moments(chaotic_system, 20, 12);
  die_at_moments(stiff_system, 0, 12);
}

TEST_CASE("a run with lists of times killed at moments from start to end ends, resumed, as one never killed",
          "[cli][resume][kill][times][slow]") {
  die_at_moments(listed_run(), 0, 12);
}

TEST_CASE("a projected run killed at moments from start to end ends, resumed, as one never killed",
          "[cli][resume][kill][projection][slow]") {
  die_at_moments(projected_run(), 20, 8);
}

TEST_CASE("runs on groups, by an action and of a block, killed at moments from start to end, end as ones never killed",
          "[cli][resume][kill][lie][variational][slow]") {
  for (const std::string& scene : {top_run, action_run, block_run}) die_at_moments(scene, 20, 4);
}

TEST_CASE("so they do for hundreds of deaths", "[cli][resume][kill][.][nightly]") {
  die_at_moments(small_run, 20, 120);
  die_at_moments(large_run, 2, 40);
  for (const std::string& scene : {stiff_system, listed_run()}) die_at_moments(scene, 0, 60);
  for (const std::string& scene : {chaotic_system, top_run, action_run, block_run}) die_at_moments(scene, 20, 30);
}

}  // namespace
}  // namespace noether::test

#endif

/// [integrator.projection] through every command.

#include "io/inspect.hpp"
#include "tests/cli/support.hpp"

#include <charconv>
#include <cmath>
#include <string>
#include <vector>

namespace noether::test {
namespace {

const std::string projected_orbit = R"(title = "A planet whose steps are projected"
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
method = "rk4"
step = 0.05
steps = 200
[integrator.projection]
onto = ["energy", "angular_momentum"]
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
const std::string free_steps =
    " --set integrator.method=dop853 --set integrator.step= --set integrator.steps= --set integrator.until=10";
const std::string bare = " --set integrator.projection=";

std::string digest_of_run(const ScratchFolder& folder, const std::string& to) {
  return json_member(output(folder, "run scene.toml --json --out " + to), "digest");
}
double worst_energy_of(const ScratchFolder& folder, const std::string& sets) {
  const std::string report = output(folder, "run scene.toml --json --fresh --out worst" + sets);
  const std::string text = json_member(json_member(report, "energy"), "worst");
  double value = std::nan("");
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

TEST_CASE("a scene with a projection is described, explained and run", "[cli][projection]") {
  const SceneFolder folder(projected_orbit);
  CHECK(has(output(folder, "list decorators"), "projection  brings every step back to invariants"));
  CHECK(has(output(folder, "describe projection"), "energy, momentum, angular_momentum, constraints"));
  CHECK(has(output(folder, "explain scene.toml"), "decorator projection, onto"));
  CHECK(worst_energy_of(folder, "") < 1e-14);
  CHECK(worst_energy_of(folder, bare) > 1e-7);
  CHECK(worst_energy_of(folder, free_steps) < 1e-14);
  CHECK(has(output(folder, "run scene.toml --out told"), "projection: "));
  CHECK(has(output(folder, "run scene.toml --json --out told"), "\"projection\":{\"steps\":200,"));
  CHECK_FALSE(has(output(folder, "run scene.toml --out told" + bare), "projection: "));
  // The scene as it was run reads back to the same run.
  const std::string scene = io::info(folder / "told/run.h5").scene_toml;
  CHECK_FALSE(has(scene, "[integrator.projection]"));
  output(folder, "run scene.toml --quiet --fresh --out again");
  write_text(folder / "again.toml", io::info(folder / "again/run.h5").scene_toml);
  CHECK(json_member(output(folder, "run again.toml --json --out third"), "digest") == digest_of_run(folder, "fourth"));
}

TEST_CASE("projected runs have the same bits on any threads, at any cadence and across a restart",
          "[cli][projection]") {
  for (const std::string& sets :
       {std::string(), std::string(" --set integrator.method=verlet --set integrator.projection.how=symmetric"),
        std::string(" --set integrator.method=adams_bashforth_4"), free_steps}) {
    CAPTURE(sets);
    const SceneFolder folder(projected_orbit);
    const std::string digest = digest_of_run(folder, "a" + sets);
    CHECK(digest_of_run(folder, "b --threads 2" + sets) == digest);
    CHECK(digest_of_run(folder, "c --set every.0.steps=1" + sets) == digest);
    CHECK(digest_of_run(folder, "d --set every.0.steps=7" + sets) == digest);
    output(folder, "run scene.toml --quiet --out e --until 3.3" + sets);
    CHECK(digest_of_run(folder, "e --resume --until 10" + sets) == digest);
    CHECK(digest_of_run(folder, "f" + sets + bare) != digest);
  }
}

TEST_CASE("a run that was projected in another way is not gone on with", "[cli][projection]") {
  const SceneFolder folder(projected_orbit);
  output(folder, "run scene.toml --quiet --out a --until 3.3");
  const auto refused = [&](const std::string& sets) {
    return noether(folder, "run scene.toml --quiet --out a --resume" + sets).err;
  };
  CHECK(has(refused(" --set 'integrator.projection.onto=[\"energy\"]'"), "integrator.projection.onto"));
  CHECK_FALSE(refused(bare).empty());
}

TEST_CASE("projected methods are compared, advised, and tried for stability", "[cli][projection]") {
  const SceneFolder folder(projected_orbit);
  const std::string table =
      output(folder, "compare scene.toml --methods verlet,rk4 --steps 0.05 --repeat 1 --json --out x");
  CHECK(has(table, "in quad"));
  CHECK(has(table, "decorator 'projection' is left out of it"));
  CHECK(has(output(folder, "stability scene.toml --methods rk4 --steps 1000 --budget 1"),
            "every method is wrapped by projection"));
  CHECK(has(output(folder, "advise scene.toml --error 1e-3 --methods rk4,verlet"), "--set 'integrator.method="));
  CHECK(has(output(folder, "evaluate scene.toml"), "gravity"));
  output(folder, "run scene.toml --quiet --out a");
  CHECK(noether(folder, "verify a/run.h5").exit_code == 0);
}

TEST_CASE("the shadow of a projected run is refused", "[cli][projection]") {
  const SceneFolder folder(projected_orbit);
  CHECK(has(noether(folder, "run scene.toml --set integrator.method=verlet --set every.0.type=shadow_hamiltonian").err,
            "a projection moves the state after every step, so the motion has no action"));
}

}  // namespace noether::test

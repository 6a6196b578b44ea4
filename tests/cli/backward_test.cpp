// Scenes that go back in time by methods that choose their steps: runs, files, restarts, and what the studies say.

#include "forces/gravity.hpp"
#include "integrators/classical.hpp"
#include "io/digest.hpp"
#include "io/inspect.hpp"
#include "scene/scene.hpp"
#include "tests/cli/support.hpp"
#include "tests/support/drivers.hpp"

#include <string>

namespace noether::test {
namespace {

/// Two bodies on an ellipse, back to time -10.
const std::string bodies_back =
    two_bodies.substr(0, two_bodies.find("[integrator]")) +
    "[integrator]\nmethod = \"dop853\"\nuntil = -10\n\n[[every]]\ntype = \"energy\"\nevery = -0.5\n";
const std::string with_files =
    bodies_back + "\n[[every]]\ntype = \"trajectory\"\nevery = -0.7\n\n[[every]]\ntype = \"checkpoint\"\nsteps = 3\n";

TEST_CASE("a scene goes back in time to the bits of a simulation", "[cli][backward]") {
  const SceneFolder folder(bodies_back);
  const ProcessResult result = noether(folder, "run scene.toml --json");
  CHECK(result.exit_code == 0);
  CHECK(json_member(result.out, "outcome") == "\"completed\"");
  CHECK(json_member(result.out, "time") == "-10");
  CHECK(json_member(result.out, "samples") == "21");
  const Scene scene = load_scene(folder / "scene.toml");
  Simulation<double> run(scene.particles, classical_over(Gravity{.G = 1}, method("dop853")));
  REQUIRE(run.run_until(-10).ok());
  CHECK(json_member(result.out, "digest") == "\"" + io::digest(run.particles()) + "\"");
  const ProcessResult told = noether(folder, "explain scene.toml");
  CHECK(told.exit_code == 0);
  CHECK(has(told.out, "every -0.5 of time"));
}

TEST_CASE("comparisons, advice and verdicts go forward, and say so", "[cli][backward][messages]") {
  const SceneFolder folder(bodies_back);
  for (const char* command : {"compare scene.toml", "advise scene.toml --error 1e-6"}) {
    CAPTURE(command);
    const ProcessResult result = noether(folder, command);
    CHECK(result.exit_code == 2);
    CHECK(result.err == "scene.toml: a comparison goes forward, over a time above 0; this one would end at -10\n");
  }
  const SceneFolder judged(bodies_back + "\n[[verdict]]\nmethods = [\"dop853\"]\noutcome = \"bounded\"\n");
  const ProcessResult result = noether(judged, "stability scene.toml --suite");
  CHECK(result.exit_code == 2);
  CHECK(result.err == "scene.toml: a verdict needs a run that goes forward in time; this one would end at -10\n");
  CHECK(noether(folder, "compare scene.toml --until 1 --methods verlet,dop853 --repeat 1").exit_code == 0);
}

#if NOETHER_HDF5

TEST_CASE("a run back in time that was cut ends as one that was not, files and all", "[cli][backward][resume]") {
  for (const char* method : {"dop853", "ias15", "bdf", "adams_pece"}) {
    CAPTURE(method);
    const std::string set = std::string(" --json --set integrator.method=") + method;
    const SceneFolder whole(with_files), cut(with_files);
    const ProcessResult straight = noether(whole, "run scene.toml" + set);
    CHECK(straight.exit_code == 0);
    CHECK(noether(cut, "run scene.toml --until -4.2" + set).exit_code == 0);
    const ProcessResult resumed = noether(cut, "run scene.toml --resume" + set);
    CHECK(resumed.exit_code == 0);
    check_same_run(resumed.out, straight.out);
    check_same_content(cut / "scene.out/run.h5", whole / "scene.out/run.h5");
    CHECK(io::info(whole / "scene.out/run.h5").frames == 15);
    CHECK(io::info(whole / "scene.out/run.h5").last_time == -9.8);
    CHECK(io::info(whole / "scene.out/checkpoint.h5").last_time == -10);
    CHECK(noether(whole, "verify scene.out/run.h5").exit_code == 0);
  }
}

TEST_CASE("a run that has gone back takes an earlier end only", "[cli][backward][resume][messages]") {
  const SceneFolder folder(bodies_back.substr(0, bodies_back.find("every = -0.5")) + "steps = 2\n");
  CHECK(noether(folder, "run scene.toml --quiet").exit_code == 0);
  const auto refusal = [&](const std::string& more) {
    const ProcessResult result = noether(folder, "run scene.toml --resume " + more);
    CHECK(result.exit_code == 2);
    return result.err;
  };
  CHECK(refusal("--until -5") ==
        "scene.toml: the end at time -5 lies before the checkpoint at time -10; give a later one, or --fresh\n");
  CHECK(refusal("--until 5") ==
        "scene.toml: the end at time 5 lies in the opposite direction: the checkpoint is at time -10; give a time "
        "below 0, or "
        "--fresh\n");
}

#endif

}  // namespace
}  // namespace noether::test

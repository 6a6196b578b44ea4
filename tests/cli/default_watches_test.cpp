// Scenes without [[every]]: the energy and about 200 frames, kept when the run goes on to another end.

#include "io/inspect.hpp"
#include "scene/scene.hpp"
#include "tests/cli/support.hpp"

#include <filesystem>
#include <string>

namespace noether::test {
namespace {

namespace fs = std::filesystem;

const std::string unwatched_orbit = two_bodies.substr(0, two_bodies.find("[[every]]"));
const std::string lorenz_until_two = R"(units = "reduced"
[system]
type = "lorenz"
[integrator]
method = "dop853"
rtol = 1e-7
until = 2
)";

Scene read_unwatched(const std::string& text, const std::vector<std::string>& sets = {}) {
  return read_scene(text, "scene.toml", standard_parts(), sets);
}

TEST_CASE("a scene without [[every]] is stored with its default watches, and every = [] without", "[cli][scene]") {
  const Scene scene = read_unwatched(unwatched_orbit, {"integrator.steps=3659"});
  CHECK(scene.default_watches);
  const std::string cadence = "steps = 18\n";
  CHECK(has(scene.effective_toml, "[[every]]\ntype = \"energy\"\n" + cadence));
  if (NOETHER_HDF5 != 0) CHECK(has(scene.effective_toml, "[[every]]\ntype = \"trajectory\"\n" + cadence));
  CHECK(read_scene(scene.effective_toml, "scene.toml").effective_toml == scene.effective_toml);
  const Scene divided = read_unwatched(unwatched_orbit, {"integrator.steps=3660"});
  CHECK(divided.watches.front().cadence.steps == 20);  // 3660 / 20 = 183 frames, the last at the end
  CHECK(read_unwatched(unwatched_orbit, {"integrator.steps=100"}).watches.front().cadence.steps == 1);
  const Scene bare = read_unwatched(unwatched_orbit, {"every=[]"});
  CHECK(bare.watches.empty());
  CHECK_FALSE(bare.default_watches);
  CHECK(has(bare.effective_toml, "every = []\n"));
  CHECK(read_scene(bare.effective_toml, "scene.toml").effective_toml == bare.effective_toml);
}

TEST_CASE("default watches change neither the trajectory nor what a program assembles", "[cli][scene]") {
  const SceneFolder folder(unwatched_orbit);
  const std::string watched = noether(folder, "run scene.toml --json").out;
  const std::string bare = noether(folder, "run scene.toml --json --out b --set every=[]").out;
  CHECK(json_member(watched, "digest") == json_member(bare, "digest"));
  CHECK(json_member(watched, "digest").size() > 64);
  CHECK(json_member(json_member(watched, "energy"), "samples") == "101");
  CHECK(json_member(bare, "monitors") == "{}");
  Simulation<double> sim = assemble(read_unwatched(unwatched_orbit));
  int attached = 0;
  sim.for_each_monitor([&](const std::string&, AnyMonitor<double>&) { ++attached; });
  CHECK(attached == 0);
}

TEST_CASE("explain tells default watches, and systems have no energy", "[cli][explain]") {
  const SceneFolder folder(unwatched_orbit), system(lorenz_until_two);
  CHECK(has(output(folder, "explain scene.toml"), "\n  monitor energy, every 1 step, by default\n"));
  const std::string text = output(system, "explain scene.toml");
  CHECK_FALSE(has(text, "monitor energy, every"));
  if (NOETHER_HDF5 != 0) CHECK(has(text, "\n  writer trajectory, every 0.01 of time, by default\n"));
}

#if NOETHER_HDF5

TEST_CASE("a scene without [[every]] leaves frames, of fixed steps and of free ones", "[cli][run]") {
  const SceneFolder folder(unwatched_orbit), system(lorenz_until_two);
  output(folder, "run scene.toml --quiet");
  CHECK(io::info(folder / "scene.out/run.h5").frames == 101);
  output(folder, "plot scene.out/run.h5");
  output(system, "run scene.toml --quiet");
  const io::FileInfo info = io::info(system / "scene.out/run.h5");
  CHECK(info.frames == 201);
  CHECK(info.last_time == 2);
  output(folder, "run scene.toml --quiet --out b --set every=[]");
  CHECK_FALSE(fs::exists(folder / "b/run.h5"));
}

TEST_CASE("a run with default watches goes on to a later end with the cadence it began with", "[cli][resume]") {
  const SceneFolder folder(unwatched_orbit);
  output(folder, "run scene.toml --quiet --set integrator.steps=400");
  CHECK(io::info(folder / "scene.out/run.h5").frames == 201);
  const std::string longer = output(folder, "run scene.toml --json --resume --set integrator.steps=2000");
  CHECK(json_member(longer, "step") == "2000");
  CHECK(io::info(folder / "scene.out/run.h5").frames == 1001);
  CHECK(json_member(json_member(longer, "energy"), "samples") == "1001");
  CHECK(noether(folder, "run scene.toml --resume --set integrator.steps=4000 --set integrator.step=0.02").exit_code ==
        2);
}

#endif

}  // namespace
}  // namespace noether::test

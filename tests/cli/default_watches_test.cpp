// Scenes without [[every]]: the energy and about 200 frames, kept when the run goes on to another end.

#include "scene/default_watches.hpp"
#include "io/checkpoint.hpp"
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

TEST_CASE("default watches divide the steps where 100 to 400 frames do", "[cli][scene]") {
  const auto every = [](std::int64_t steps) {
    const Scene scene = read_unwatched(unwatched_orbit, {"integrator.steps=" + std::to_string(steps)});
    return scene.watches.front().cadence.steps;
  };
  CHECK(every(3653) == 13);  // 281 frames
  CHECK(every(20000) == 100);
  CHECK(every(9286) == 46);  // twice a prime: the last frame is not the end
  CHECK(every(1) == 1);
  CHECK(every(250) == 1);
  CHECK(every(0) == 1);
  for (const std::int64_t steps : {400, 1010, 1030, 12'300, 399'000}) CHECK(steps % every(steps) == 0);
}

TEST_CASE("default watches follow the run: another start, time that falls, one particle", "[cli][scene]") {
  const auto interval = [](const std::vector<std::string>& sets) {
    return read_unwatched(lorenz_until_two, sets).watches.front().cadence.interval;
  };
  CHECK(interval({"integrator.start_time=1"}) == 0.005);
  CHECK(interval({"integrator.until=-2"}) == -0.01);
  CHECK(read_unwatched(unwatched_orbit, {"integrator.start_time=5", "integrator.until=9"})
            .watches.front()
            .cadence.steps == 2);
  CHECK(read_unwatched(unwatched_orbit, {"integrator.step=-0.01"}).watches.front().cadence.steps == 1);
  const Scene alone = read_unwatched(R"(units = "reduced"
[particles]
body = [{mass = 1, x = [1, 0, 0], v = [0, 0, 0]}]
[hamiltonian]
type = "kinetic_potential"
force = [{type = "harmonic_field", k = 1}]
[integrator]
method = "verlet"
step = 0.01
steps = 1000
)");
  CHECK(alone.watches.front().cadence.steps == 5);
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

TEST_CASE("default frames of an adaptive method reach the end, and those of a resumed run are those of an unbroken one",
          "[cli][resume]") {
  const auto sets = [](const std::string& start, const std::string& until) {
    return " --set integrator.start_time=" + start + " --set integrator.until=" + until;
  };
  const SceneFolder folder(lorenz_until_two);
  output(folder, "run scene.toml --quiet" + sets("0.1", "7.3"));
  const io::FileInfo info = io::info(folder / "scene.out/run.h5");
  CHECK(info.frames == 201);
  CHECK(info.last_time == 7.3);
  output(folder, "run scene.toml --quiet --resume" + sets("0.1", "9.7"));
  const std::string every = " --set 'every=[{type=\"trajectory\", every=0.036}]'";
  output(folder, "run scene.toml --quiet --out whole" + sets("0.1", "9.7") + every);
  check_same_content(folder / "scene.out/run.h5", folder / "whole/run.h5");
  output(folder, "run scene.toml --quiet --out back" + sets("0.1", "-0.7"));
  CHECK(io::info(folder / "back/run.h5").last_time == -0.7);
}

TEST_CASE("an adaptive run looks at its end where rounding alone says that the look is later", "[cli][resume]") {
  const SceneFolder folder(lorenz_until_two);
  const std::string every = " --set 'every=[{type=\"trajectory\", every=0.1}]' --set integrator.until=";
  for (const auto& [until, frames] : {std::pair{"0.3", 4}, std::pair{"0.6", 7}, std::pair{"0.7", 8},
                                      std::pair{"1.2", 13}, std::pair{"1.8", 19}, std::pair{"56", 561}}) {
    output(folder, "run scene.toml --quiet --resume" + every + until);  // each goes on from the one before
    const io::FileInfo info = io::info(folder / "scene.out/run.h5");
    INFO(until);
    CHECK(info.frames == frames);
    CHECK(info.last_time == std::stod(until));
  }
  output(folder, "run scene.toml --quiet --out whole" + every + "56");
  check_same_content(folder / "scene.out/run.h5", folder / "whole/run.h5");
  const std::string times = " --set 'every=[{type=\"trajectory\", times=[0.30000000000000004, 1]}]' --out t";
  output(folder, "run scene.toml --quiet --set integrator.until=0.3" + times);  // the look keeps its own time
  CHECK(io::info(folder / "t/run.h5").last_time == 0.30000000000000004);
  output(folder, "run scene.toml --quiet --resume --set integrator.until=1" + times);
  output(folder, "run scene.toml --quiet --set integrator.until=1 --out u" + times.substr(0, times.find(" --out")));
  check_same_content(folder / "t/run.h5", folder / "u/run.h5");
}

TEST_CASE("[[every]] taken out between run and resume is told, and the run keeps its cadence", "[cli][resume]") {
  const SceneFolder folder(lorenz_until_two);
  const std::string watched = " --set 'every=[{type=\"trajectory\", every=0.25}]'";
  output(folder, "run scene.toml --quiet" + watched);
  const ProcessResult resumed = noether(folder, "run scene.toml --resume --set integrator.until=3");
  CHECK(resumed.exit_code == 0);
  CHECK(
      has(resumed.err,
          "note: the scene has no [[every]], so the run keeps the cadence it began with: trajectory at every = 0.25"));
  CHECK(io::info(folder / "scene.out/run.h5").frames == 13);
  for (const char* until : {"3", "4", "5"}) {  // told once, and not of a run that is over
    CHECK(noether(folder, std::string("run scene.toml --resume --set integrator.until=") + until).err.empty());
  }
  CHECK(io::info(folder / "scene.out/run.h5").frames == 21);
}

TEST_CASE("a run that only ever had the default cadence goes on twice without a note on it", "[cli][resume]") {
  const SceneFolder folder(lorenz_until_two);
  output(folder, "run scene.toml --quiet");
  for (const char* until : {"3", "4", "5"}) {
    CHECK(noether(folder, std::string("run scene.toml --resume --set integrator.until=") + until).err.empty());
  }
  CHECK(io::info(folder / "scene.out/run.h5").frames == 501);
}

TEST_CASE("a kept cadence is told once, also where the run that told it was killed", "[cli][resume]") {
  const SceneFolder folder(lorenz_until_two);
  output(folder, "run scene.toml --quiet --set 'every=[{type=\"trajectory\", every=0.25}]'");
  CHECK_FALSE(noether(folder, "run scene.toml --resume --set integrator.until=3").err.empty());
  make_unfinished(folder / "scene.out");  // the checkpoint before is the one that had not been told yet
  CHECK_FALSE(noether(folder, "run scene.toml --resume --set integrator.until=3").err.empty());
  CHECK(noether(folder, "run scene.toml --resume --set integrator.until=4").err.empty());
  // So does one that wrote a checkpoint on its way and was killed after it.
  Scene going_on = read_unwatched(unwatched_orbit);
  for (const bool kept : {false, true}) {
    going_on.kept_watches = kept;
    const fs::path file = folder / (kept ? "kept.h5" : "new.h5");
    SceneFiles files;
    files.checkpoint = file;
    files.checkpoint_wall = 1e-9;
    REQUIRE(assemble(going_on, files).run(100).ok());
    CHECK(told_of_kept_watches(io::read_checkpoint(file).run) == kept);
  }
}

TEST_CASE("a proposal knows files of nearly the same extension, and folders of runs", "[cli]") {
  const SceneFolder folder(unwatched_orbit);
  CHECK(has(noether(folder, "run scene.tml").err, "; did you mean 'scene.toml'?"));
  CHECK_FALSE(has(noether(folder, "run scene.csv").err, "did you mean"));
  output(folder, "run scene.toml --quiet --out kk");
  CHECK(has(noether(folder, "run kk").err, "; the folder holds a run, 'kk/run.h5'"));
  output(folder, "run scene.toml --quiet --out bare --set every=[]");
  CHECK(has(noether(folder, "info bare").err, "; the folder holds a checkpoint, 'bare/checkpoint.h5'"));
}

#endif

TEST_CASE("--set on a table of a list that is not there says what that means", "[cli]") {
  const SceneFolder folder(unwatched_orbit);
  for (const char* set : {"every.0.type=energies", "every.0.steps=10"}) {
    CHECK(has(noether(folder, std::string("run scene.toml --set ") + set).err,
              "the scene has no [[every]], so it is watched by default; write [[every]] tables to choose"));
  }
}

}  // namespace
}  // namespace noether::test

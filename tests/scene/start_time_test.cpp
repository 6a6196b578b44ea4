// Scenes whose clock does not begin at 0, and lists of times: what is read, kept, warned of, and where it leads.

#include "io/digest.hpp"
#include "monitors/monitors.hpp"
#include "scene/scene.hpp"
#include "scene/warnings.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/process.hpp"
#include "tests/support/refusal.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace noether::test {
namespace {

const std::string sun_and_comet = R"(units = "solar"
[[particles.body]]
name = "Sun"
mass = "1 Msun"
[[particles.body]]
name = "Comet"
mass = "1e-9 Msun"
q = "0.5 au"
e = 0.9
T = "100 day"
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "gravity"
[integrator]
method = "yoshida_4"
step = "0.5 day"
until = "200 day"
[[every]]
type = "energy"
every = "10 day"
)";

Scene clocked(const std::vector<std::string>& sets, const std::string& text = sun_and_comet) {
  return read_scene(text, "scene.toml", standard_parts(), sets);
}

/// The times at which a monitor of the scene has looked.
struct TimesSeen {
  std::vector<double>* times;
  void observe(const Snapshot<double>& now) const { times->push_back(now.time()); }
};

}  // namespace

TEST_CASE("a scene that says no start_time, or 0, is the scene it was", "[scene][start time]") {
  const Scene bare = clocked({}), zero = clocked({"integrator.start_time=0 day"});
  CHECK(bare.effective_toml == zero.effective_toml);
  CHECK(bare.effective_toml.find("start_time") == std::string::npos);
  CHECK(clock_of(zero.integrator).start() == 0);
}

TEST_CASE("until is a time of the clock, steps and cadences count from the start", "[scene][start time]") {
  const Scene scene = clocked({"integrator.start_time=1000 day", "integrator.until=1200 day"});
  CHECK(scene.integrator.start == 1000);
  CHECK(scene.integrator.steps == 400);
  CHECK(scene.watches[0].cadence.steps == 20);
  CHECK(scene.integrator.length() == 200);
  CHECK(scene.effective_toml.find("start_time = \"1000 day\"\n") != std::string::npos);
  // What files keep is read again as the same scene.
  CHECK(clocked({}, scene.effective_toml).effective_toml == scene.effective_toml);
  CHECK(clocked({"integrator.start_time=1000 day", "integrator.until=", "integrator.steps=400"}).integrator.steps ==
        400);
  const Scene back = clocked({"integrator.method=dop853", "integrator.step=", "integrator.start_time=1000 day",
                              "integrator.until=800 day", "every.0.every=-10 day"});
  CHECK(back.integrator.direction() == Direction::backward);
  CHECK(back.integrator.length() == -200);
  CHECK(clock_of(back.integrator).start() == 1000);
  const Scene below = clocked(
      {"integrator.method=dop853", "integrator.step=", "integrator.start_time=-1000 day", "integrator.until=-800 day"});
  CHECK(below.integrator.direction() == Direction::forward);
}

TEST_CASE("the comet passes its pericenter so long after the start, whatever the clock shows", "[scene][start time]") {
  Scene scene = clocked({}), later = clocked({"integrator.start_time=2451545 day", "integrator.until=2451745 day"});
  CHECK(same_bits(scene.particles, later.particles));
  Simulation<double> run = assemble(scene), other = assemble(later);
  REQUIRE(run.run(400).ok());
  REQUIRE(other.run_until(2451745).ok());
  CHECK(same_bits(run.particles(), other.particles()));
  CHECK(other.time() == 2451745);
  CHECK(other.step() == 400);
  CHECK(io::digest(run.particles()) != io::digest(other.particles()));  // the time is in it
}

TEST_CASE("a driven scene from another time is where its closed form is", "[scene][start time]") {
  const std::string text = R"(units = "reduced"
[particles]
body = [{ name = "ball", mass = 1, x = [0.25, 0, 0], v = [-0.5, 0, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "oscillating_field"
acceleration = [0.7, 0, 0]
omega = 1.25
phase = 0.5
[integrator]
start_time = 1000
)";
  const double w = 1.25, g = 0.7, a = w * 1000 + 0.5, b = w * 1004 + 0.5;
  const double exact = 0.25 + (-0.5 - g / w * std::sin(a)) * 4 - g / (w * w) * (std::cos(b) - std::cos(a));
  for (const std::string method :
       {"method = 'yoshida_8'\nstep = 0.015625\nuntil = 1004\n", "method = 'rk4'\nstep = 0.0009765625\nsteps = 4096\n",
        "method = 'dop853'\nrtol = 1e-12\natol = 1e-12\nuntil = 1004\n", "method = 'gauss_8'\nuntil = 1004\n"}) {
    CAPTURE(method);
    const Scene scene = clocked({}, text + method);
    Simulation<double> run = assemble(scene);
    if (scene.integrator.steps) REQUIRE(run.run(*scene.integrator.steps).ok());
    if (scene.integrator.until) REQUIRE(run.run_until(*scene.integrator.until).ok());
    CHECK(run.time() == 1004);
    CHECK(std::abs(run.particles().positions()[0][0] - exact) < 1e-9);
  }
}

TEST_CASE("systems begin with their start, one held to a solution of time begins on it", "[scene][start time]") {
  const auto of = [](const std::string& type, const std::string& keys, const std::string& more) {
    return clocked({}, "units = 'reduced'\n[system]\ntype = '" + type + "'\n" + keys +
                           "[integrator]\nmethod = 'rodas_5p'\nrtol = 1e-8\natol = 1e-10\n" + more);
  };
  const Scene stiff = of("prothero_robinson", "", "start_time = 1000\nuntil = 1002\n");
  Simulation<double> run = assemble(stiff);
  CHECK(std::abs(run.particles().variables()[0] - std::sin(1000 + M_PI / 4)) < 1e-12);
  REQUIRE(run.run_until(1002).ok());
  REQUIRE(stiff.system->exact);
  CHECK(std::abs(run.particles().variables()[0] - stiff.system->exact(1002)[0]) < 1e-6);
  const Scene line = of("heat_line", "points = 7\n", "start_time = 1000\nuntil = 1000.1\n"),
              bare = of("heat_line", "points = 7\n", "until = 0.1\n");
  CHECK(line.particles.variables() == bare.particles.variables());
  CHECK(bare.system->exact);
  CHECK_FALSE(line.system->exact);  // it is one of time from 0 on
  Simulation<double> heat = assemble(line);
  REQUIRE(heat.run_until(1000.1).ok());
  CHECK(std::abs(heat.particles().variables()[3] - bare.system->exact(1000.1 - 1000)[3]) < 1e-6);
}

TEST_CASE("a list of times is read from the scene or a file, and kept as a list", "[scene][times]") {
  const Scene listed = clocked({"every.0.times=[\"10 day\", \"30.5 day\", \"100 day\"]"});
  CHECK(listed.watches[0].cadence.times == std::vector<double>{10, 30.5, 100});
  CHECK(listed.watches[0].cadence.steps == 0);  // --set puts it in the place of `every`
  CHECK(clocked({}, listed.effective_toml).effective_toml == listed.effective_toml);
  const ScratchFolder folder;
  write_text(folder / "when.txt", "# days of looking\n\n10 day\n 30.5 day # half\n100 day\n");
  const Scene file = read_scene(sun_and_comet, folder / "scene.toml", standard_parts(), {"every.0.times=when.txt"});
  CHECK(file.watches[0].cadence.times == listed.watches[0].cadence.times);
  CHECK(file.effective_toml == listed.effective_toml);
  write_text(folder / "when.txt", "10 day\n30.5\n");
  CHECK_THROWS_WITH(read_scene(sun_and_comet, folder / "scene.toml", standard_parts(), {"every.0.times=when.txt"}),
                    Catch::Contains("when.txt:2: '30.5' has no unit"));
  write_text(folder / "when.txt", "# nothing\n");
  CHECK_THROWS_WITH(read_scene(sun_and_comet, folder / "scene.toml", standard_parts(), {"every.0.times=when.txt"}),
                    Catch::Contains("there is no time in this file; one per line is expected"));
  std::vector<double> seen;
  Simulation<double> run = assemble(listed);
  run.at_times(listed.watches[0].cadence.times, TimesSeen{&seen});
  REQUIRE(run.run_until(200).ok());
  CHECK(seen == listed.watches[0].cadence.times);
}

TEST_CASE("times after the end are warned of, and of a moved end they are seen", "[scene][times]") {
  const std::string set = "every.0.times=[\"10 day\", \"200 day\", \"201 day\"]";
  CHECK(warnings_of(clocked({set})) ==
        std::vector<std::string>{"1 of 3 times of 'energy' lies after the end at 200 day, so it does not sample then"});
  CHECK(warnings_of(clocked({set, "integrator.until=201 day"})).empty());
  CHECK(warnings_of(clocked({set, "integrator.until=", "integrator.steps=402"})).empty());
  CHECK(warnings_of(clocked({set, "integrator.until="})).empty());  // no end is known
  const std::vector<std::string> adaptive = {"integrator.method=dop853",
                                             "integrator.step=", "every.0.times=[\"1005 day\", \"1011.25 day\"]",
                                             "integrator.start_time=1000 day", "integrator.until=1010 day"};
  CHECK(
      warnings_of(clocked(adaptive)) ==
      std::vector<std::string>{"1 of 2 times of 'energy' lies after the end at 1010 day, so it does not sample then"});
}

TEST_CASE("where times are exact, one between two steps is refused with the nearest of the clock",
          "[scene][times][messages]") {
  CHECK(refusal_of([] {
          clocked({"integrator.exact=true", "integrator.start_time=1000 day", "integrator.until=1200 day",
                   "every.0.times=[\"1010.25 day\"]"});
        })
            .ends_with(
                "times contains \"1010.25 day\", which is 20.5 steps of \"0.5 day\" after \"1000 day\"; the nearest "
                "whole numbers are \"1010 day\" (20 steps) and \"1010.5 day\" (21 steps)"));
}

TEST_CASE("a list may begin with the start in another unit", "[scene][times]") {
  // 1.1 yr of 365.25 days is 401.775 days, but for the last bit.
  const Scene scene = clocked({"integrator.start_time=1.1 yr", "integrator.until=601.775 day",
                               "every.0.times=[\"401.775 day\", \"411.775 day\"]"});
  CHECK(scene.watches[0].cadence.times.at(0) == scene.integrator.start);
  std::vector<double> seen;
  Simulation<double> run = assemble(scene);
  run.at_times(scene.watches[0].cadence.times, TimesSeen{&seen});
  REQUIRE(run.run_until(601.775).ok());
  REQUIRE(seen.size() == 2);
  CHECK(seen[0] == scene.integrator.start);
  CHECK(refusal_of([] {
          clocked({"integrator.start_time=1.1 yr", "integrator.until=601.775 day", "every.0.times=[\"401 day\"]"});
        }).find("times contains \"401 day\", which the run does not reach") != std::string::npos);
}

}  // namespace noether::test

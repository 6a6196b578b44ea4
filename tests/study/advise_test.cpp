// Advice: what it proposes is run, and has to come true.

#include "study/advise.hpp"
#include "scene/evaluate.hpp"
#include "study/set_lines.hpp"
#include "tests/study/scenes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/process.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace noether::test {
namespace {

/// Runs what was proposed over the whole scene, and measures it.
Row proposed(const Scene& scene, const Proposal& p, double end) {
  CompareOptions options;
  options.methods = {p.who.label};
  options.until = end;
  if (p.who.adaptive) options.tolerances = {p.setting.tolerance};
  if (!p.who.adaptive) options.steps = {p.setting.step};
  options.repeats = 1;
  options.row_budget = 60;
  options.truth.budget = 300;
  return compare(scene, options).rows.at(0);
}

TEST_CASE("what advice predicts for a longer run comes true", "[advise][slow]") {
  // Four times as long as the trials: 10000 steps of the scene.
  const Scene scene = kepler(0.2, "method = \"verlet\"\nstep = 0.02\nsteps = 40000");
  for (const Metric metric : {Metric::position, Metric::energy}) {
    AdviseOptions options;
    options.error = 1e-6;
    options.metric = metric;
    options.methods = {"verlet", "blanes_moan_s6", "kahan_li_8_s17", "rk4", "dop853", "gauss_8"};
    const Advice advice = advise(scene, options);
    REQUIRE(advice.proposals.size() >= 2);
    CHECK(advice.end == 800);
    CHECK(advice.trial_end == 200);
    for (const Proposal& p : advice.proposals) {
      const Row row = proposed(scene, p, advice.end);
      const auto error = metric == Metric::position ? row.position_error_max : row.energy_error_max;
      INFO(p.who.label << " step " << p.setting.step << ": predicted " << p.predicted_error << ", found " << *error);
      CHECK(p.predicted_error <= options.error);
      CHECK(*error < 2 * options.error);
      // A tolerance may lead to steps 1.25 times shorter than another one near it, and those to errors of 1.25^-15.
      CHECK(*error > p.predicted_error / (p.who.adaptive ? 28 : 3));
      CHECK(*error < p.predicted_error * 3);
      if (p.who.adaptive) {
        CHECK(std::abs(static_cast<double>(row.evaluations.force) / p.predicted_evaluations - 1) < 0.25);
        continue;
      }
      // A comparison shortens steps to divide the time between its samples.
      const double shorter = p.setting.step > 0 ? p.setting.step / row.setting.step : 1;
      CHECK(shorter >= 1 - 1e-9);
      CHECK(shorter < 1.2);
      CHECK(std::abs(static_cast<double>(row.evaluations.force) / (p.predicted_evaluations * shorter) - 1) < 0.02);
    }
  }
}

/// A scene in a file, which lines of advice are read with.
struct SceneFile : ScratchFolder {
  explicit SceneFile(const std::string& text) { write_text(*this / "scene.toml", text); }
  Scene load(const std::vector<std::string>& sets = {}) const {
    return load_scene(*this / "scene.toml", standard_parts(), sets);
  }
};

TEST_CASE("the cheapest proposal comes first, and its lines run the scene", "[advise]") {
  const SceneFile file(spring +
                       "[[every]]\ntype = \"energy\"\nevery = 0.5\n[integrator]\nmethod = \"verlet\"\n"
                       "step = 0.05\nuntil = 100\n");
  const Scene scene = file.load({"hamiltonian.force.harmonic_field.k=4"});
  AdviseOptions options;
  options.error = 1e-7;
  options.methods = {"verlet", "blanes_moan_s6", "rk4", "dormand_prince_5"};
  const Advice advice = advise(scene, options);
  INFO(to_text(advice, scene));
  REQUIRE(advice.proposals.size() >= 2);
  CHECK(std::is_sorted(advice.proposals.begin(), advice.proposals.end(),
                       [](const Proposal& a, const Proposal& b) { return a.predicted_wall_s < b.predicted_wall_s; }));
  std::vector<std::string> sets = {"hamiltonian.force.harmonic_field.k=4"};  // what was set before stays
  sets.insert(sets.end(), advice.sets.begin(), advice.sets.end());
  const Scene changed = file.load(sets);
  CHECK(changed.integrator.method == advice.proposals.front().who.method);
  if (!changed.integrator.adaptive()) CHECK(changed.integrator.step == advice.proposals.front().setting.step);
  Simulation<double> sim = assemble(changed);
  REQUIRE((changed.integrator.adaptive() ? sim.run_until(100) : sim.run(*changed.integrator.steps)).ok());
  CHECK(std::abs(sim.time() - 100) < 1e-9);
  CHECK(std::abs(sim.particles().positions()[0][0] - std::cos(200.0)) < 2e-7);
  const std::string json = to_json(advice, scene);
  CHECK(json.starts_with("{\"schema\":\"noether.advise/1\""));
  for (const char* key : {"\"method\":", "\"step\":", "\"predicted_error\":", "\"predicted_wall_s\":", "\"set\":["}) {
    CHECK(json.find(key) != std::string::npos);
  }
}

TEST_CASE("lines of advice that leave a splitting keep every force", "[advise]") {
  const SceneFile file(R"(units = "reduced"
[particles]
body = [{ name = "star", mass = 1, x = [0, 0, 0], v = [0, 0, 0] },
        { name = "planet", mass = 1e-3, x = [1, 0, 0.1], v = [0, 1, 0] }]
[hamiltonian]
type = "wisdom_holman"
coordinates = "democratic"
G = 1.5
[[hamiltonian.force]]
type = "oblateness"
J2 = 0.01
radius = 0.5
[integrator]
method = "verlet"
step = 0.05
until = 20
)");
  const Scene scene = file.load();
  const Candidate who = candidate(scene, "blanes_moan_s6@kinetic_potential");
  const SetLines lines = set_lines(scene, who, {.step = 0.1}, 20);
  REQUIRE(lines.refusal.empty());
  CHECK(lines.lines.front() == "hamiltonian.coordinates=");
  const Scene changed = file.load(lines.lines);
  CHECK(changed.hamiltonian.splitting.name == "kinetic_potential");
  const double expected = evaluate(scene).potential;
  CHECK(std::abs(evaluate(changed).potential / expected - 1) < 1e-15);
  // Gravity alone is another number: -1.5e-3 / sqrt(1.01).
  CHECK(std::abs(-1.5e-3 / std::sqrt(1.01) / expected - 1) > 1e-4);
}

TEST_CASE("lines of advice take out what means nothing to the method", "[advise]") {
  const SceneFile adaptive(spring + "[integrator]\nmethod = \"dop853\"\nrtol = 1e-9\natol = 1e-12\nuntil = 50\n");
  AdviseOptions options;
  options.error = 1e-6;
  options.methods = {"verlet", "blanes_moan_s6"};
  const Advice advice = advise(adaptive.load(), options);
  REQUIRE(advice.proposals.size() == 2);
  CHECK(advice.left_out.empty());
  for (const Proposal& p : advice.proposals) CHECK(adaptive.load(p.sets).integrator.method == p.who.method);

  const SceneFile watched(spring +
                          "[[every]]\ntype = \"shadow_hamiltonian\"\nsteps = 10\n[integrator]\nmethod = \"verlet\"\n"
                          "step = 0.1\nuntil = 50\n");
  options.methods = {"rk4"};
  const Advice refused = advise(watched.load(), options);
  CHECK(refused.proposals.empty());
  CHECK(refused.reason.starts_with("rk4 holds it, but the scene refuses its lines: "));
  CHECK(refused.left_out == std::vector<std::string>{refused.reason});
}

TEST_CASE("lines of advice take out a corrector and a kernel that the method was not tried with", "[advise]") {
  const Scene scene = outer_solar_system({"integrator.method=verlet_aba", "integrator.corrector=17",
                                          "integrator.kernel=composed", "integrator.second_corrector=true"});
  const SceneValue& written = *scene.effective.find("integrator");
  REQUIRE(written.find("corrector") != nullptr);
  REQUIRE(written.find("second_corrector") != nullptr);
  for (const char* name : {"verlet", "aba_10_6_4", "verlet_aba@kinetic_potential", "dop853"}) {
    INFO(name);
    const Candidate who = candidate(scene, name);
    const Setting setting{.step = who.adaptive ? 0 : scene.integrator.step, .tolerance = who.adaptive ? 1e-9 : 0};
    const SetLines lines = set_lines(scene, who, setting, 1000 * scene.integrator.step);
    CHECK(lines.refusal == "");
    std::vector<std::string> all = scene.source.sets;
    all.insert(all.end(), lines.lines.begin(), lines.lines.end());
    const Scene changed = load_scene(scene.file, *scene.parts, all), tried = variant(scene, who, setting);
    CHECK_FALSE(changed.integrator.composition.changes_scheme());
    CHECK_FALSE(tried.integrator.composition.changes_scheme());
    CHECK(changed.effective.find("integrator")->find("corrector") == nullptr);
  }
  const Candidate own = candidate(scene, "verlet_aba");
  CHECK(variant(scene, own, {.step = scene.integrator.step, .tolerance = 0}).integrator.composition.corrector == 17);
  const SetLines kept = set_lines(scene, own, {.step = scene.integrator.step, .tolerance = 0}, 1000);
  for (const std::string& line : kept.lines) CHECK_FALSE(line.starts_with("integrator.corrector"));
}

TEST_CASE("advice that cannot be given is refused, or says why there is none", "[advise]") {
  const Scene scene = oscillator("method = \"verlet\"\nstep = 0.1\nsteps = 400");
  CHECK_THROWS_WITH(advise(scene, {.error = 0}), "an error of 0 cannot be held; a number between 0 and 1 is expected");
  CHECK_THROWS_WITH(advise(scene, {.error = -1e-3}),
                    "an error of -0.001 cannot be held; a number between 0 and 1 is expected");
  AdviseOptions options;
  options.error = 1e-13;
  options.methods = {"verlet"};
  const Advice advice = advise(scene, options);
  CHECK(to_text(advice, scene).starts_with("tried 1 method, 5 runs over 40; "));
  CHECK(advice.proposals.empty());
  CHECK(advice.sets.empty());
  CHECK(advice.reason == "the one method tried does not hold an error of 1e-13 over the whole run");

  const Scene brief = oscillator("method = \"verlet\"\nstep = 0.01\nsteps = 3");
  const Advice untold = advise(brief, options);
  CHECK(untold.proposals.empty());
  CHECK(untold.reason == "the trials do not tell how errors depend on the step; a longer run would tell more");
}

TEST_CASE("lines of advice meet the end and the listed times of a run from another start", "[advise]") {
  for (const auto& [start, times] : {std::pair(100.0, "[101, 105.5, 119.95]"), std::pair(-7.3, "[-7.3, -1, 3.2]")}) {
    for (const char* method : {"method = \"verlet\"\nstep = 0.05\n", "method = \"dop853\"\nrtol = 1e-9\n"}) {
      const SceneFile file(spring +
                           fmt::format("[[every]]\ntype = \"energy\"\ntimes = {}\n[integrator]\n{}start_time = "
                                       "{}\nuntil = {}\n",
                                       times, method, start, start + 20));
      AdviseOptions options;
      options.error = 1e-5;
      options.methods = {"verlet", "dop853"};
      const Advice advice = advise(file.load(), options);
      INFO(to_text(advice, file.load()));
      CHECK(advice.end == 20);
      REQUIRE(advice.proposals.size() == 2);
      for (const Proposal& p : advice.proposals) {
        Simulation<double> sim = assemble(file.load(p.sets));
        REQUIRE(sim.run_until(start + 20).ok());
        CHECK(std::abs(sim.particles().positions()[0][0] - std::cos(20.0)) < 2e-5);
        sim.for_each_monitor(
            [](const std::string&, AnyMonitor<double>& monitor) { CHECK(monitor.report()->samples == 3); });
      }
    }
  }
}

/// A spring that tells no energy.
struct MuteSpring {
  static constexpr auto describe() { return part<MuteSpring>("mute_spring", "a spring without an energy"); }
  static constexpr auto claims() { return ForceClaims{.energy = false}; }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) out.acceleration(i, -Vec3<Real>(s.positions()[i]));
  }
};

TEST_CASE("a metric that the scene cannot be measured by is refused by name", "[advise]") {
  const Scene heat = read_scene(R"(units = "reduced"
[system]
type = "heat_line"
points = 8
[integrator]
method = "rk4"
step = 1e-3
steps = 100
)",
                                "heat.toml");
  AdviseOptions options;
  options.error = 1e-6;
  options.metric = Metric::energy;
  CHECK_THROWS_WITH(advise(heat, options),
                    "the energy cannot be measured here: system 'heat_line' has none; try --metric position");
  Parts parts = standard_parts();
  parts.add_force<MuteSpring>();
  const Scene mute = read_scene(R"(units = "reduced"
[particles]
body = [{ name = "bob", mass = 1, x = [1, 0, 0], v = [0, 0, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "mute_spring"
[integrator]
method = "verlet"
step = 0.01
steps = 100
)",
                                "mute.toml", parts);
  options.methods = {"verlet"};
  CHECK_THROWS_WITH(advise(mute, options),
                    "the energy cannot be measured here: not every force computes its own; try --metric position");
}

TEST_CASE("errors below the rounding of doubles are held by methods of two words", "[advise][two words][slow]") {
  const Scene scene = two_planets("method = \"gauss_8\"\nuntil = 400");
  AdviseOptions options;
  options.error = 1e-15;
  options.metric = Metric::position;
  const Advice advice = advise(scene, options);
  INFO(advice.reason);
  REQUIRE_FALSE(advice.proposals.empty());
  const Proposal& best = advice.proposals.front();
  CHECK(best.who.below_rounding);
  CHECK(best.predicted_error <= options.error);
  const Row row = proposed(scene, best, advice.end);
  INFO(best.who.label << " step " << best.setting.step);
  CHECK(row.position_error_max.value() < 2 * options.error);
  options.error = 1e-8;  // doubles do
  for (const Candidate& who : advise(scene, options).trials.methods) CHECK_FALSE(who.below_rounding);
}

TEST_CASE("times between steps do not shorten the steps of a method that has states there", "[advise][two words]") {
  AdviseOptions options;
  options.error = 1e-15;
  options.methods = {"encke_gauss_8"};
  const auto step = [&](const std::string& looks) {
    const Advice advice = advise(two_planets("method = \"encke_gauss_8\"\nstep = 0.5\nuntil = 100" + looks), options);
    INFO(advice.reason);
    REQUIRE(advice.proposals.size() == 1);
    return advice.proposals.front().setting.step;
  };
  CHECK(step("\n[[every]]\ntype = \"energy\"\ntimes = [1.23, 45.65]\n") == step(""));
}

}  // namespace
}  // namespace noether::test

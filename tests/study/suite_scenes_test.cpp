// Scenes of the suite: what their verdicts, bounds of energies, do not ask.

#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/free_rotor.hpp"
#include "study/candidate.hpp"
#include "study/suite.hpp"
#include "tests/study/scenes.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace noether::test {
namespace {

Scene suite_scene(const std::string& name, const std::vector<std::string>& sets = {}) {
  return load_scene(std::string(NOETHER_SOURCE_DIR) + "/study/suite/" + name, standard_parts(), sets);
}

/// Energy of two bodies about each other, over their reduced mass.
double pair_energy(const ParticleSystem<double>& s, Index i, Index j) {
  const Vec3<double> x = s.positions()[j] - s.positions()[i], v = s.velocities()[j] - s.velocities()[i];
  return norm2(v) / 2 - (s.masses()[i] + s.masses()[j]) / std::sqrt(norm2(x));
}

TEST_CASE("of the Pythagorean three bodies the lightest leaves a pair of the others", "[suite]") {
  for (const char* name : {"gauss_radau_15", "gauss_8"}) {
    Simulation<double> run = assemble(suite_scene("pythagorean.toml", {std::string("integrator.method=") + name}));
    REQUIRE(run.run_until(70).ok());
    const ParticleSystem<double>& s = run.particles();
    const auto apart = [&](Index i, Index j) {
      return std::sqrt(norm2(Vec3<double>(s.positions()[j] - s.positions()[i])));
    };
    CAPTURE(name, apart(0, 1), apart(0, 2), apart(1, 2));
    CHECK(pair_energy(s, 1, 2) < 0);
    CHECK(apart(1, 2) < 2);
    CHECK(apart(0, 1) > 10 * apart(1, 2));
    // The lightest against the centre of the pair: faster than its escape speed, and away.
    const Vec3<double> x = s.positions()[0] - (4 * s.positions()[1] + 5 * s.positions()[2]) / 9,
                       v = s.velocities()[0] - (4 * s.velocities()[1] + 5 * s.velocities()[2]) / 9;
    CHECK(norm2(v) / 2 - 12 / std::sqrt(norm2(x)) > 0);
    CHECK(dot(x, v) > 0);
  }
}

/// Distance of the tracer of Sitnikov's problem from the axis, v = 1.9, on a circle.
double off_axis(const std::string& method, double x, double until) {
  Simulation<double> run = assemble(suite_scene(
      "sitnikov.toml", {"integrator.method=" + method, "integrator.rtol=1e-13", "integrator.atol=1e-13",
                        "particles.body.tracer.v=[0, 0, 1.9]", fmt::format("particles.body.tracer.x=[{}, 0, 0]", x)}));
  REQUIRE(run.run_until(until).ok());
  const Vec3<double> at = run.particles().positions()[2];
  return std::hypot(at[0], at[1]);
}

TEST_CASE("a tracer on Sitnikov's axis stays on it to the last bit, and off it leaves by Floquet's multiplier",
          "[suite]") {
  // By the variational equations, solved by an independent script: in half a period distances grow 2.9946-fold.
  constexpr double half_period = 26.218341426, multiplier = 2.994588848;
  for (const char* method : {"gauss_8", "gauss_radau_15", "dop853"}) {
    CAPTURE(method);
    CHECK(off_axis(method, 0, 6283.2) == 0);
    const double first = off_axis(method, 1e-12, 8 * half_period), last = off_axis(method, 1e-12, 14 * half_period);
    CHECK(std::abs(std::pow(last / first, 1.0 / 6) / multiplier - 1) < 2e-3);
  }
}

/// How far the bodies are, after a third of a period, from where the ones before them were, or the ones behind them.
double change_of_places(Simulation<double>& run) {
  const ParticleSystem<double> before = run.particles();
  REQUIRE(run.run_until(run.time() + 6.325913978 / 3).ok());
  double best = 1;
  for (const Index shift : {1, 2}) {
    double worst = 0;
    for (Index i = 0; i < 3; ++i) {
      const Vec3<double> off = run.particles().positions()[i] - before.positions()[(i + shift) % 3];
      worst = std::max(worst, std::sqrt(norm2(off)));
    }
    best = std::min(best, worst);
  }
  return best;
}

TEST_CASE("after 1000 periods the three bodies still follow each other on the figure-eight", "[suite]") {
  for (const char* name : {"blanes_moan_s6", "srkn14a"}) {
    Simulation<double> run = assemble(suite_scene(
        "figure_eight.toml", {std::string("integrator.method=") + name, "integrator.step=0.02108637992666667"}));
    REQUIRE(run.run_until(6325.913978).ok());
    const double off = change_of_places(run);
    CAPTURE(name, off);
    CHECK(off < 1e-6);
  }
}

/// The step that a verdict asks for, as it stands there; empty: the scene's own.
std::string step_of(const SceneVerdict& verdict) {
  for (const std::string& set : verdict.sets) {
    if (set.starts_with("integrator.step=")) return set.substr(16);
    if (set.starts_with("integrator.method=")) return "adaptive";
  }
  return "";
}

TEST_CASE("every method that can run the chain of Fermi, Pasta and Ulam has a verdict at each of its steps",
          "[suite]") {
  const Scene scene = suite_scene("fermi_pasta_ulam.toml");
  std::map<std::string, std::multiset<std::string>> fixed;
  std::multiset<std::string> adaptive;
  for (const SceneVerdict& verdict : scene.verdicts) {
    auto& asked = step_of(verdict) == "adaptive" ? adaptive : fixed[step_of(verdict)];
    asked.insert(verdict.methods.begin(), verdict.methods.end());
    const bool tells = verdict.sharing_below || verdict.sharing_above || verdict.outcome != "bounded";
    CHECK(tells);
  }
  std::vector<std::string> names;
  for (const Scheme* scheme : schemes::all()) names.emplace_back(scheme->name);
  for (const MethodInfo* info : methods::all()) names.emplace_back(info->name);
  int serving = 0;
  for (const std::string& name : names) {
    CAPTURE(name);
    const MethodInfo* info = methods::find(name);
    if (info != nullptr && info->adaptive) CHECK(adaptive.count(name) == 2);  // at two tolerances
    if (info != nullptr && !info->fixed) continue;
    try {
      static_cast<void>(fixed_candidate(scene, name));
    } catch (const Error&) {
      continue;  // it cannot serve the scene
    }
    ++serving;
    for (const char* step : {"", "0.025", "0.1"}) CHECK(fixed[step].count(name) == 1);
  }
  CHECK(serving > 90);
}

TEST_CASE("theory has a verdict for every method on the oscillator, at three steps", "[suite]") {
  const Scene scene = suite_scene("oscillator.toml");
  std::set<std::string> steps;
  for (const SceneVerdict& verdict : scene.verdicts) {
    if (verdict.every_method && verdict.outcome == "theory") steps.insert(step_of(verdict));
  }
  CHECK(steps == std::set<std::string>{"", "2.0", "2.1"});  // the scene's own is 1.9
  CHECK(scene.integrator.step == 1.9);
  std::vector<std::string> names;
  for (const Scheme* scheme : schemes::all()) names.emplace_back(scheme->name);
  for (const MethodInfo* info : methods::all()) {
    if (info->fixed && !info->gravity_only) names.emplace_back(info->name);
  }
  CHECK(names.size() > 90);
  for (const std::string& name : names) {
    CAPTURE(name);
    for (const double step : {1.9, 2.0, 2.1}) {
      CHECK_FALSE(expected_by_theory(scene, fixed_candidate(scene, name), step).empty());
    }
  }
}

TEST_CASE("bodies that turn ten thousand times in a step turn right to the rounding of the angle", "[suite]") {
  const Scene scene = suite_scene("many_turns.toml");
  Simulation<double> run = assemble(scene);
  REQUIRE(run.run(3).ok());
  const ParticleSystem<double>&start = scene.particles, &now = run.particles();
  for (Index i = 0; i < start.size(); ++i) {
    if (start.name(i) == "beside the separatrix") continue;  // where it is after so long cannot be told
    CAPTURE(start.name(i));
    // The same turn in 113 bits, all of it at once.
    const Vec3<double> spin = start.column<BodySpin>()[i], inertia = start.column<BodyInertia>()[i];
    const Quaternion<double> q = start.column<BodyOrientation>()[i], turned = now.column<BodyOrientation>()[i];
    const Quaternion<Quad> truth =
        turn_exactly<Quad>(q.cast<Quad>(), spin.cast<Quad>(), inertia.cast<Quad>(), Quad(3)).orientation;
    const double angle = 3 * rate_in_body<double>(spin_in_body<double>(q, spin), inertia).norm();
    for (int k = 0; k < 4; ++k) {
      CHECK(std::abs(static_cast<double>(Quad(turned[k]) - truth[k])) <= 3e-16 * angle);  // no spin: to the bit
    }
  }
}

TEST_CASE("of two rocks a light one goes its way, and where they touch the run ends and names one", "[suite]") {
  const Suite suite = run_suite({std::string(NOETHER_SOURCE_DIR) + "/study/suite/rocks.toml"});
  int ended = 0;
  for (const SuiteRow& row : suite.rows) {
    CAPTURE(row.method, row.sets, row.found, row.energy_error.value_or(-1), row.message);
    CHECK(row.agrees);
    if (row.expected != "unbounded") continue;
    ++ended;
    CHECK_THAT(row.message, Catch::Contains("of planet is not finite"));
  }
  CHECK(ended == 1);
}

TEST_CASE("spheres of a sheet bounce, come to rest, or end the run as they pile up", "[suite]") {
  const Suite suite = run_suite({std::string(NOETHER_SOURCE_DIR) + "/study/suite/hard_spheres.toml"});
  int ended = 0;
  for (const SuiteRow& row : suite.rows) {
    CAPTURE(row.method, row.sets, row.found, row.energy_error.value_or(-1), row.message);
    CHECK(row.agrees);
    if (row.expected != "solver") continue;
    ++ended;
    CHECK_THAT(row.message, Catch::Contains("spheres pile up: they touch more than 1000 times each in one flow"));
  }
  CHECK(ended == 1);
}

}  // namespace
}  // namespace noether::test

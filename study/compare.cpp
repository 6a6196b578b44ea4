#include "study/compare.hpp"

#include "integrators/all_methods.hpp"
#include "numbers/parallel.hpp"
#include "numbers/simd.hpp"
#include "numbers/version.hpp"
#include "study/analysis.hpp"
#include "study/find_truth.hpp"
#include "study/wide_scene.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>

namespace noether {

namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

/// The step a scene takes, or the mean one of a method that chooses.
double own_step(const Scene& scene, const Sampling& sampling) {
  if (!scene.integrator.adaptive()) return scene.integrator.step;
  Scene alone = scene;
  alone.watches.clear();
  alone.stops.clear();
  Simulation<double> sim = assemble(alone);
  static_cast<void>(sim.run_until(sampling.start + sampling.interval));
  return sim.step() > 0 ? sampling.interval / static_cast<double>(sim.step()) : sampling.interval;
}

/// Steps of an candidate that cost as much as the scene's own: four times as long to eight times as short, by twos.
std::vector<double> ladder(const Scene& scene, const Candidate& who, const Sampling& sampling) {
  const double own = own_step(scene, sampling);
  const double measured_at = std::min(own, sampling.interval);
  double factor = 1;
  if (!scene.integrator.adaptive()) {
    const Candidate self{scene.integrator.method, scene.integrator.method, false, false};
    const double mine = evaluations_per_step(scene, self, measured_at);
    const double other = evaluations_per_step(scene, who, measured_at);
    if (mine > 0 && other > 0) factor = other / mine;
  } else {
    const double other = evaluations_per_step(scene, who, measured_at);
    if (other > 0) factor = other / 12;
  }
  std::vector<double> steps;
  for (double step = 4 * own * factor; steps.size() < 6; step /= 2) steps.push_back(step);
  return steps;
}

void check(const CompareOptions& options, const Sampling& sampling) {
  for (const double step : options.steps) {
    if (!(step > 0) || !std::isfinite(step))
      throw Error(fmt::format("a step of {} is not valid; a time above 0 is expected", step));
    if (step > sampling.interval * (1 + 1e-9)) {
      throw Error(
          fmt::format("a step of {:.6g} is longer than the {:.6g} between two of the {} moments at which runs are "
                      "compared; give shorter steps, or a longer --until",
                      step, sampling.interval, sampling.samples));
    }
    static_cast<void>(sampling.steps_for(step));
  }
  for (const double tolerance : options.tolerances) {
    if (!(tolerance > 0 && tolerance < 1)) {
      throw Error(fmt::format("{} is not a valid tolerance; a number between 0 and 1 is expected", tolerance));
    }
  }
  if (options.repeats < 1) throw Error(fmt::format("{} repeats are too few; 1 or more is expected", options.repeats));
  if (!(options.row_budget > 0)) {
    throw Error(fmt::format("a budget of {} s is not valid; a number above 0 is expected", options.row_budget));
  }
}

/// @throws Error  for steps or tolerances that no method takes
void check_use(const Scene& scene, const std::vector<Candidate>& methods, const CompareOptions& options) {
  const auto adaptive = [](const Candidate& who) { return who.adaptive; };
  if (!options.steps.empty() && std::all_of(methods.begin(), methods.end(), adaptive)) {
    throw Error(
        "--steps is for methods of fixed steps, but all the methods compared choose theirs by a tolerance; leave it "
        "out, or add such a method, such as 'rk4'");
  }
  if (!options.tolerances.empty() && std::none_of(methods.begin(), methods.end(), adaptive)) {
    throw Error(
        "--tolerances is for methods that choose their steps, but all the methods compared take fixed ones; leave it "
        "out, or add such a method, such as 'dop853'");
  }
  for (const Candidate& who : methods) {
    if (!who.adaptive) continue;
    for (const double tolerance : options.tolerances)
      check_options(*scene.parts->find_method(who.method), {.rtol = tolerance});
  }
}

std::vector<Candidate> opponents_of(const Scene& scene, const CompareOptions& options) {
  if (options.methods.empty()) return default_opponents(scene);
  std::vector<Candidate> all;
  for (const std::string& name : options.methods) {
    Candidate who = candidate(scene, name);
    if (std::find(all.begin(), all.end(), who) == all.end()) all.push_back(std::move(who));
  }
  return all;
}

Comparison headed(const Scene& scene, const Sampling& sampling) {
  Comparison c;
  c.scene = scene.source.file;
  c.title = scene.title;
  c.time_unit = scene.units->time;
  c.hamiltonian = scene.system ? scene.system->name : scene.hamiltonian.splitting.name;
  c.machine = processor();
  c.simd = name(simd_level());
  c.version = version();
  c.commit = commit();
  c.date = fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)));
  c.threads = thread_count();
  c.particles = scene.particles.size();
  c.sampling = sampling;
  c.end = sampling.end();
  const SceneIntegrator& own = scene.integrator;
  const double whole = own.until ? *own.until - own.start : own.steps ? static_cast<double>(*own.steps) * own.step : 0;
  if (std::abs(whole - c.end) > 1e-9 * whole) c.scene_end = whole;
  return c;
}

}  // namespace

Sampling sampling_of(const Scene& scene, const std::optional<double>& until) {
  const SceneIntegrator& own = scene.integrator;
  double end = until ? *until - own.start : own.until ? *own.until - own.start : 0;  // from the start on
  if (!until && !own.until) {
    if (!own.steps || own.step == 0) {
      throw SceneError("the scene has no end; give until or steps in [integrator], or --until",
                       {.file = scene.source.file, .key = "integrator.until"});
    }
    end = static_cast<double>(std::min(*own.steps, longest_steps)) * own.step;
  }
  if (!until && !own.until && !(end > 0)) {
    throw SceneError(
        fmt::format(
            "a step of {} goes back in time; methods are compared forward in time, so a step above 0 is expected",
            own.step),
        {.file = scene.source.file, .key = "integrator.step", .value = fmt::format("{}", own.step)});
  }
  if (!(end > 0) || !std::isfinite(end)) {
    const std::string from = own.start == 0 ? "" : fmt::format(", from a start at {}", own.start);
    throw SceneError(fmt::format("a comparison goes forward, over a time above 0; this one would end at {}{}",
                                 own.start + end, from),
                     {.file = scene.source.file, .key = "integrator.until"});
  }
  Sampling sampling;
  sampling.interval = end / sampling.samples;
  sampling.start = own.start;
  return sampling;
}

std::vector<Setting> settings_of(const Scene& scene, const Candidate& who, const Sampling& sampling,
                                 const CompareOptions& options) {
  std::vector<Setting> settings;
  if (who.adaptive) {
    std::vector<double> tolerances = options.tolerances;
    if (tolerances.empty()) tolerances = {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14};
    std::sort(tolerances.rbegin(), tolerances.rend());
    for (const double one : tolerances) settings.push_back({.step = 0, .tolerance = one});
    return settings;
  }
  std::vector<double> steps = options.steps.empty() ? ladder(scene, who, sampling) : options.steps;
  std::sort(steps.rbegin(), steps.rend());
  std::int64_t last = 0;
  for (const double step : steps) {
    const std::int64_t count = sampling.steps_for(step);
    if (count == last) continue;  // one division of the interval stands for both
    last = count;
    settings.push_back({.step = sampling.interval / static_cast<double>(count), .tolerance = 0});
  }
  return settings;
}

Comparison compare(const Scene& scene, const CompareOptions& options) {
  refuse_noise(scene);
  const Sampling sampling = sampling_of(scene, options.until);
  check(options, sampling);
  const auto tell = [&](const std::string& what) {
    if (options.progress) options.progress(what);
  };
  Comparison c = headed(scene, sampling);
  c.methods = opponents_of(scene, options);
  check_use(scene, c.methods, options);
  std::vector<std::vector<Setting>> settings;  // all before anything runs: one that cannot be is told at once
  for (const Candidate& who : c.methods) settings.push_back(settings_of(scene, who, sampling, options));
  tell("reference in extended precision");
  c.truth = find_truth(scene, sampling, options.truth);
  for (std::size_t i = 0; i < c.methods.size(); ++i) {
    const Candidate& who = c.methods[i];
    for (const Setting& setting : settings[i]) {
      const std::string with =
          who.adaptive ? fmt::format("rtol {:.0e}", setting.tolerance) : fmt::format("step {:.4g}", setting.step);
      tell(fmt::format("{}, {}", who.label, with));
      c.rows.push_back(
          measure(scene, who, setting, sampling, {.repeats = options.repeats, .budget = options.row_budget}));
    }
  }
  PositionError error(scene.particles, about_center(scene));
  error.set_scale(c.truth.y);
  if (!c.truth.has_states()) use_finest_run(c, error);
  error.set_scale(c.truth.y);
  for (std::size_t i = 0; i < c.rows.size(); ++i) {
    const Truth none{.name = c.truth.name, .energy = c.truth.energy};
    set_errors(c.rows[i], c.reference == i ? none : c.truth, sampling, error);
  }
  c.position_measured = c.truth.has_states();
  analyse(c);
  return c;
}

}  // namespace noether

#include "study/compare.hpp"

#include "integrators/all_methods.hpp"
#include "numbers/parallel.hpp"
#include "numbers/simd.hpp"
#include "numbers/version.hpp"
#include "study/analysis.hpp"
#include "study/find_truth.hpp"
#include "study/horizon.hpp"
#include "study/truth_in_double.hpp"
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

namespace {

/// Whether the equations keep an energy, so that no truth is needed to tell its error.
bool keeps_energy(const Scene& scene) {
  const IntegratorClaims claims = assemble(scene).claims();
  return claims.energy && !claims.dissipative && !claims.time_dependent && scene.particles.size() > 0;
}

/// A comparison on its way.
class Comparer {
 public:
  Comparer(const Scene& scene, const CompareOptions& options)
      : scene_(scene), options_(options), error_(scene.particles, about_center(scene)) {}

  Comparison run() {
    const Sampling asked = sampling_of(scene_, options_.until);
    check(options_, asked);
    const Horizon paid = affordable_horizon(scene_, asked, !options_.until, options_.row_budget);
    c_ = headed(scene_, paid.sampling);
    c_.limits = paid.told;
    c_.methods = opponents_of(scene_, options_);
    check_use(scene_, c_.methods, options_);
    choose_settings();  // before anything runs: one that cannot be is told at once
    find_reference();
    measure_rows();
    conclude();
    return std::move(c_);
  }

 private:
  bool many() const { return scene_.particles.size() > most_bodies; }
  void tell(const std::string& what, int row = 0, double done = 0) const {
    if (options_.progress) options_.progress({row, rows(), done, what});
  }
  int rows() const {
    std::size_t all = 0;
    for (const auto& of_one : settings_) all += of_one.size();
    return static_cast<int>(all);
  }

  void choose_settings() {
    settings_.clear();
    for (const Candidate& who : c_.methods) settings_.push_back(settings_of(scene_, who, c_.sampling, options_));
  }

  /// A truth in extended precision; where there is none, and the motion is chaotic or of many, one in double precision,
  /// over the time for which there can be one.
  void find_reference() {
    c_.truth = {.name = "invariants", .note = "positions are not asked for"};
    if (!options_.positions && keeps_energy(scene_)) return;
    tell("reference in extended precision");
    c_.truth = find_truth(scene_, c_.sampling, options_.truth);
    if (c_.truth.has_states() || scene_.particles.size() > most_particles) return;
    const double left = std::max(options_.truth.budget - c_.truth.seconds, options_.truth.budget / 2);
    tell("how fast small differences grow");
    c_.motion = predictability(scene_, c_.sampling.end(), left / 4);
    Horizon told{.sampling = c_.sampling};
    if (c_.motion) told = predictable_horizon(scene_, c_.sampling, !options_.until, *c_.motion);
    if (!many() && told.told.empty()) return;
    shorten(told);
    if (options_.until && c_.motion && c_.motion->rounding(c_.end) > 1e-3) return;  // nothing tells positions there
    tell("reference in double precision");
    const std::string why = c_.truth.note;
    c_.truth = truth_in_double(scene_, c_.sampling, left, error_);
    c_.truth.note += fmt::format("; {}", why);
  }

  void shorten(const Horizon& told) {
    if (told.told.empty()) return;
    c_.limits += (c_.limits.empty() ? "" : "; ") + told.told;
    if (told.sampling.interval == c_.sampling.interval) return;
    const Comparison before = std::move(c_);
    c_ = headed(scene_, told.sampling);
    c_.limits = before.limits;
    c_.methods = before.methods;
    c_.motion = before.motion;
    c_.truth = before.truth;
    choose_settings();
  }

  void measure_rows() {
    error_.set_scale(c_.truth.y);
    const bool known = c_.truth.has_states();
    const MeasureOptions how{.repeats = options_.repeats,
                             .budget = options_.row_budget,
                             .states = known && scene_.particles.size() <= most_particles,
                             .quick = options_.quick,
                             .shadow = !options_.quick};
    for (std::size_t i = 0; i < c_.methods.size(); ++i) {
      for (std::size_t k = 0; k < settings_[i].size(); ++k) {
        tell_row(i, k);
        Row row = measure(scene_, c_.methods[i], settings_[i][k], c_.sampling, how);
        if (known) set_errors(row, c_.truth, c_.sampling, error_);
        if (known && many()) row.track.y = {};  // those of all rows would not fit into memory
        c_.rows.push_back(std::move(row));
      }
    }
  }

  /// The rows of a method cost about twice as much one after the other, and each method about the same.
  void tell_row(std::size_t i, std::size_t k) const {
    const Candidate& who = c_.methods[i];
    const Setting& setting = settings_[i][k];
    const std::string with =
        who.adaptive ? fmt::format("rtol {:.0e}", setting.tolerance) : fmt::format("step {:.4g}", setting.step);
    const auto up_to = [](std::size_t n) { return std::exp2(static_cast<double>(n)) - 1; };
    const double done =
        (static_cast<double>(i) + up_to(k) / up_to(settings_[i].size())) / static_cast<double>(c_.methods.size());
    tell(fmt::format("{}, {}", who.label, with), static_cast<int>(c_.rows.size()) + 1, done);
  }

  void conclude() {
    const bool known = c_.truth.has_states();
    if (!known && options_.positions) use_finest_run(c_, error_);
    error_.set_scale(c_.truth.y);
    for (std::size_t i = 0; i < c_.rows.size() && !known; ++i) {
      const Truth none{.name = c_.truth.name, .energy = c_.truth.energy};
      set_errors(c_.rows[i], c_.reference == i ? none : c_.truth, c_.sampling, error_);
    }
    c_.position_measured = c_.truth.has_states();
    analyse(c_);
  }

  const Scene& scene_;
  const CompareOptions& options_;
  PositionError error_;
  Comparison c_;
  std::vector<std::vector<Setting>> settings_;  ///< method by method
};

}  // namespace

Comparison compare(const Scene& scene, const CompareOptions& options) {
  refuse_noise(scene);
  return Comparer(scene, options).run();
}

}  // namespace noether

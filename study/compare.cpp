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
#include <functional>
#include <limits>

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
/// @param spent  is increased by the evaluations that this takes
double own_step(const Scene& scene, const Sampling& sampling, double& spent) {
  if (!scene.integrator.adaptive()) return scene.integrator.step;
  Scene alone = scene;
  alone.watches.clear();
  alone.stops.clear();
  Simulation<double> sim = assemble(alone);
  static_cast<void>(sim.run_until(sampling.start + sampling.interval));
  spent += static_cast<double>(sim.evaluations().force);
  return sim.step() > 0 ? sampling.interval / static_cast<double>(sim.step()) : sampling.interval;
}

/// Steps of a candidate that cost as much as the scene's own: four times as long to eight times as short, by twos.
/// @param few  only twice as long to half as long
std::vector<double> ladder(const Scene& scene, const Candidate& who, const Sampling& sampling, double own,
                           StepCosts& costs, bool few) {
  const double measured_at = std::min(own, sampling.interval);
  double factor = 1;
  if (!scene.integrator.adaptive()) {
    const Candidate self = candidate(scene, scene.integrator.method);
    const double mine = costs.of(self, measured_at);
    const double other = costs.of(who, measured_at);
    if (mine > 0 && other > 0) factor = other / mine;
  } else {
    const double other = costs.of(who, measured_at);
    if (other > 0) factor = other / 12;
  }
  std::vector<double> steps;
  const std::size_t count = few ? fewest_rows : 6;
  for (double step = (few ? 2 : 4) * own * factor; steps.size() < count; step /= 2) steps.push_back(step);
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

namespace {

/// @param own  step of the scene
/// @param few  so few that they just tell an order
std::vector<Setting> settings_with(const Scene& scene, const Candidate& who, const Sampling& sampling,
                                   const CompareOptions& options, double own, StepCosts& costs, bool few) {
  std::vector<Setting> settings;
  if (who.adaptive) {
    std::vector<double> tolerances = options.tolerances;
    if (tolerances.empty()) tolerances = {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14};
    if (options.tolerances.empty() && few) tolerances.resize(fewest_rows);
    std::sort(tolerances.rbegin(), tolerances.rend());
    for (const double one : tolerances) settings.push_back({.step = 0, .tolerance = one});
    return settings;
  }
  std::vector<double> steps = options.steps.empty() ? ladder(scene, who, sampling, own, costs, few) : options.steps;
  std::sort(steps.rbegin(), steps.rend());
  std::int64_t last = 0;
  const auto add = [&](double step) {
    const std::int64_t count = sampling.steps_for(step);
    if (count == last) return;  // one division of the interval stands for both
    last = count;
    settings.push_back({.step = sampling.interval / static_cast<double>(count), .tolerance = 0});
  };
  for (const double step : steps) add(step);
  // Where the first ones were longer than the interval, finer ones tell the order of the method; but of a run that is
  // itself shorter than that many of its steps, nothing tells much.
  const bool may_add = options.steps.empty() && own <= sampling.interval * (1 + 1e-9);
  const auto fewest = static_cast<std::size_t>(!may_add ? 0 : few ? fewest_rows : 4);
  while (settings.size() < fewest) add(settings.back().step / 2);
  return settings;
}

}  // namespace

std::vector<Setting> settings_of(const Scene& scene, const Candidate& who, const Sampling& sampling,
                                 const CompareOptions& options) {
  StepCosts costs(scene);
  double spent = 0;
  return settings_with(scene, who, sampling, options, own_step(scene, sampling, spent), costs, false);
}

namespace {

/// Whether the equations keep an energy, so that no truth is needed to tell its error.
bool keeps_energy(const Scene& scene) {
  const IntegratorClaims claims = assemble(scene).claims();
  return claims.energy && !claims.dissipative && !claims.time_dependent;
}

/// How well two references agree that tell errors of methods with more digits than doubles.
constexpr double agreement_below_rounding = 1e-20;
/// Moments of the shortest comparison.
constexpr int fewest_samples = 4;

/// A comparison on its way.
class Comparer {
 public:
  Comparer(const Scene& scene, const CompareOptions& options)
      : scene_(scene), options_(options), costs_(scene), error_(scene.particles, about_center(scene)) {}

  Comparison run() {
    const Sampling asked = sampling_of(scene_, options_.until);
    check(options_, asked);
    work_ = options_.work ? *options_.work : may_shorten() ? allowance_of(scene_, asked) : Allowance{};
    const Horizon paid = affordable_horizon(scene_, asked, !options_.until, options_.row_budget, work_);
    c_ = headed(scene_, paid.sampling);
    c_.limits = paid.told;
    c_.methods = opponents_of(scene_, options_);
    check_use(scene_, c_.methods, options_);
    choose_settings();  // before anything runs: one that cannot be is told at once
    if (may_shorten()) fit_to_work();
    find_reference();
    measure_rows();
    conclude();
    c_.work = work_;
    return std::move(c_);
  }

 private:
  bool many() const { return scene_.particles.size() > most_bodies; }
  bool may_shorten() const { return !options_.until || options_.until_at_most; }
  void tell(const std::string& what, int row = 0, double done = 0) const {
    if (options_.progress) options_.progress({row, rows(), done, what});
  }
  /// Tells shares of a preparation.
  std::function<void(double)> teller(const std::string& what) const {
    if (!options_.progress) return {};
    tell(what);
    return [this, what](double done) { tell(what, 0, done); };
  }
  int rows() const {
    std::size_t all = 0;
    for (const auto& of_one : settings_) all += of_one.size();
    return static_cast<int>(all);
  }

  void choose_settings() {
    settings_.clear();
    own_step_ = own_step(scene_, c_.sampling, work_.spent);
    for (const Candidate& who : c_.methods)
      settings_.push_back(settings_with(scene_, who, c_.sampling, options_, own_step_, costs_, few_rows_));
    work_.spent += costs_.take_spent();
  }

  /// Evaluations of the runs that a row needs. Those of an adaptive method are not known before, and taken to be twice
  /// those of the scene's own run.
  double expected(std::size_t i, const Setting& setting) {
    const Candidate& who = c_.methods[i];
    const auto length = scene_.integrator.length();
    if (!std::isfinite(work_.most)) return 0;  // nobody needs to know
    const int runs = needed_runs(options_.quick);
    if (who.adaptive) return length ? runs * 2 * work_.own_run * c_.end / *length : 0;
    const double step = setting.step > 0 ? setting.step : c_.sampling.interval;
    const double each = costs_.of(who, std::min(own_step_, c_.sampling.interval));
    work_.spent += costs_.take_spent();
    return runs * (each > 0 ? each : 1) * c_.end / step;
  }
  double expected(std::size_t i) {
    double all = 0;
    for (const Setting& setting : settings_[i]) all += expected(i, setting);
    return all;
  }
  double expected_from(std::size_t first) {
    double all = 0;
    for (std::size_t i = first; i < settings_.size(); ++i) all += expected(i);
    return all;
  }

  /// What all rows together may take: where positions are compared, their reference takes as much.
  double room_for_rows() const { return options_.positions ? work_.left() / 2 : work_.left(); }
  bool too_much() { return expected_from(0) > room_for_rows(); }

  /// The longest step that was asked for, else of all rows as they are now [time]; 0 where none are fixed.
  double longest_step() const {
    if (!options_.steps.empty()) return *std::max_element(options_.steps.begin(), options_.steps.end());
    double longest = 0;
    for (const auto& of_one : settings_) longest = std::max(longest, of_one.front().step);
    return longest;
  }

  /// Ends the runs earlier, until measuring takes no more than the scene's own run; as far as runs still tell
  /// something.
  void fit_to_work() {
    if (!std::isfinite(work_.most) || !too_much()) return;
    const double whole = c_.end, longest = longest_step();
    double least = (options_.quick ? 200 : 80) * own_step_;
    if (!options_.steps.empty()) least = std::max(least, fewest_samples * longest);  // they are run as they are given
    const int samples = c_.sampling.samples;
    while (too_much() && c_.end / 2 >= least) take(c_.end / 2, longest, samples);
    if (options_.quick && too_much()) take_few_rows(std::min(samples, 10));
    tell_limits(whole, least);
  }

  /// Three rows over 100 steps by as many methods as there is work for.
  void take_few_rows(int samples) {
    few_rows_ = true;
    const double end = std::min(c_.end, 100 * own_step_);
    take(end, end / fewest_samples, samples);
    leave_out_methods();
    take(end, longest_step(), samples);  // as many moments as the steps of those that are left allow
  }

  void tell_limits(double whole, double least) {
    const std::string most =
        work_.most > work_.own_run
            ? fmt::format("{:.3g} evaluations of forces", work_.most)
            : fmt::format("the {:.5g} evaluations of forces of the scene's own run", work_.own_run);
    const auto add = [&](const std::string& told) { c_.limits += (c_.limits.empty() ? "" : "; ") + told; };
    const bool more = too_much();
    if (c_.end < whole) {
      add(fmt::format("runs are compared over {} of {}{}", time_in_words(c_.end, scene_),
                      time_in_words(c_.scene_end.value_or(whole), scene_),
                      more ? "" : ", so that measuring stays within " + most));
    }
    if (more) {
      add(
          fmt::format("runs end after no fewer than {:.0f} steps of the scene, so measuring takes about {:.2g} "
                      "evaluations of forces, more than {}",
                      std::min(least, c_.end) / own_step_, expected_work(), most));
    }
    if (left_out_.empty()) return;
    add(fmt::format("left out {}: {}", c_.end < whole && !more ? "for the same reason" : "to stay within " + most,
                    left_out_));
  }

  /// Evaluations of all that is measured; the reference of positions takes as much as the rows.
  double expected_work() { return work_.spent + (options_.positions ? 2 : 1) * expected_from(0); }

  /// Ends the runs at another time, with as many moments as leave room for the longest step between two of them, so
  /// that every row keeps its step.
  void take(double end, double longest, int samples) {
    Sampling sampling = c_.sampling;
    const double room = longest > 0 ? std::floor(end / longest * (1 + 1e-9)) : samples;
    sampling.samples = static_cast<int>(std::clamp<double>(room, fewest_samples, samples));
    sampling.interval = end / sampling.samples;
    start_over(sampling);
  }

  /// Keeps the methods, from the first on, that there is work for.
  void leave_out_methods() {
    std::size_t kept = 1;
    double all = expected(0);
    while (kept < c_.methods.size() && all + expected(kept) <= room_for_rows()) all += expected(kept++);
    for (std::size_t i = kept; i < c_.methods.size(); ++i)
      left_out_ += (left_out_.empty() ? "" : ", ") + c_.methods[i].label;
    c_.methods.resize(kept);
    settings_.resize(kept);
  }

  /// The same comparison with other moments.
  void start_over(const Sampling& sampling) {
    const Comparison before = std::move(c_);
    c_ = headed(scene_, sampling);
    c_.limits = before.limits;
    c_.methods = before.methods;
    c_.motion = before.motion;
    c_.truth = before.truth;
    choose_settings();
  }

  /// What a way to find the reference may take: half of what the rows leave, but as much as half of the rows in any
  /// case.
  double room_for_reference() {
    const double rows = expected_from(0);
    return std::max(work_.left() - rows, rows) / 2;
  }

  /// A truth in extended precision; where there is none, and the motion is chaotic or of many, one in double precision,
  /// over the time for which there can be one.
  void find_reference() {
    c_.truth = {.name = "invariants", .note = "positions are not asked for"};
    if (!options_.positions && keeps_energy(scene_)) return;
    TruthOptions how = options_.truth;
    how.most_evaluations = room_for_reference();
    const auto has_more_digits = [](const Candidate& who) { return who.below_rounding; };
    if (std::any_of(c_.methods.begin(), c_.methods.end(), has_more_digits))
      how.agreement = std::min(how.agreement, agreement_below_rounding);
    how.tell = teller("reference in extended precision");
    c_.truth = find_truth(scene_, c_.sampling, how);
    work_.spent += c_.truth.evaluations;
    if (c_.truth.has_states() || scene_.particles.size() > most_particles) return;
    const double left = std::max(options_.truth.budget - c_.truth.seconds, options_.truth.budget / 2);
    c_.motion = predictability(scene_, c_.sampling.end(), left / 4, room_for_reference() / 2,
                               teller("how fast small differences grow"), &work_.spent);
    Horizon told{.sampling = c_.sampling};
    if (c_.motion) told = predictable_horizon(scene_, c_.sampling, !options_.until, *c_.motion);
    if (!many() && told.told.empty()) return;
    shorten(told);
    if (options_.until && c_.motion && c_.motion->rounding(c_.end) > 1e-3) return;  // nothing tells positions there
    const std::string why = c_.truth.note;
    how.budget = left;
    how.most_evaluations = room_for_reference();
    how.tell = teller("reference in double precision");
    c_.truth = truth_in_double(scene_, c_.sampling, how, error_);
    work_.spent += c_.truth.evaluations;
    c_.truth.note += fmt::format("; {}", why);
  }

  void shorten(const Horizon& told) {
    if (told.told.empty()) return;
    c_.limits += (c_.limits.empty() ? "" : "; ") + told.told;
    if (told.sampling.interval != c_.sampling.interval) start_over(told.sampling);
  }

  void measure_rows() {
    error_.set_scale(c_.truth.y);
    const bool known = c_.truth.has_states();
    MeasureOptions how{.repeats = options_.repeats,
                       .budget = options_.row_budget,
                       .states = known && scene_.particles.size() <= most_particles,
                       .quick = options_.quick,
                       .shadow = !options_.quick};
    const RowShares shares = shares_of_rows();
    double left = shares.room;
    for (std::size_t i = 0; i < c_.methods.size(); ++i) {
      const double reserved = expected_from(i + 1);
      for (std::size_t k = 0; k < settings_[i].size(); ++k) {
        tell_row(i, k);
        if (may_shorten() && std::isfinite(work_.most)) {
          how.most_evaluations = most_of_run(i, k, left - reserved);
          how.repeat_evaluations = shares.repeats_each * expected(i, settings_[i][k]);
        }
        Row row = measure(scene_, c_.methods[i], settings_[i][k], c_.sampling, how);
        work_.spent += row.work;
        left -= static_cast<double>(row.evaluations.force) * needed_runs(options_.quick);
        if (known) set_errors(row, c_.truth, c_.sampling, error_);
        if (known && many()) row.track.y = row.track.low = {};  // those of all rows would not fit into memory
        c_.rows.push_back(std::move(row));
      }
    }
  }

  /// What rows may take. Timed repeats have a share of their own, so that it does not depend on the clock what other
  /// rows find left.
  struct RowShares {
    double room = 0;          ///< evaluations of the runs that all rows need
    double repeats_each = 0;  ///< of further repeats, for each evaluation that a row is expected to need
  };
  RowShares shares_of_rows() {
    const double all = expected_from(0), spare = std::max(0.0, work_.left() - all) / 2;
    return {work_.left() - spare, all > 0 ? spare / all : 0};
  }

  /// What one run of a row may take: all that later rows leave; and what it is expected to take in any case.
  double most_of_run(std::size_t i, std::size_t k, double left) {
    for (std::size_t later = k + 1; later < settings_[i].size(); ++later) left -= expected(i, settings_[i][later]);
    return std::max(left, 1.05 * expected(i, settings_[i][k])) / needed_runs(options_.quick) + c_.sampling.samples;
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
  StepCosts costs_;
  Allowance work_;
  double own_step_ = 0;
  bool few_rows_ = false;
  std::string left_out_;  ///< methods that there is no work for, in words
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

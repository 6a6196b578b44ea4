#include "study/advise.hpp"

#include "study/analysis.hpp"
#include "study/compare.hpp"
#include "study/horizon.hpp"
#include "study/set_lines.hpp"
#include "study/wide_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace noether {

namespace {

constexpr double margin = 0.7;                   ///< of the error that was asked for: fits scatter
constexpr double least_fit = 1e-14;              ///< no fit is believed below
constexpr double rounding_of_two_words = 1e-19;  ///< the same of states with more digits than doubles
/// Where errors are asked for that doubles may not reach, methods with more digits are tried too.
constexpr double beyond_doubles = 1e-11;
constexpr double most_steps = 1e15;

/// From the start on [time].
double end_of(const Scene& scene) {
  const SceneIntegrator& own = scene.integrator;
  if (own.until) return *own.until - own.start;
  if (own.steps && own.step != 0) return static_cast<double>(*own.steps) * own.step;
  throw SceneError("the scene has no end, so its whole run cannot be judged; give until or steps in [integrator]",
                   {.file = scene.source.file, .key = "integrator.until"});
}

std::optional<double> error_of(const Row& row, Metric metric) {
  if (!row.completed()) return {};
  return metric == Metric::position ? row.position_error_max : row.energy_error_max;
}

/// Exponent of the growth of the largest error so far, over the last half of the logarithm of a trial.
std::optional<double> measured_exponent(const Row& row, const Truth& truth, Metric metric) {
  const std::vector<double> errors = metric == Metric::position ? row.position_errors : energy_errors(row.track, truth);
  constexpr std::size_t fewest = 9;  // moments, the start among them: an eighth of the others is one
  if (errors.size() < fewest) return {};
  const std::size_t last = errors.size() - 1, first = last / 8;
  double early = 0, late = 0;
  for (std::size_t j = 1; j <= last; ++j) {
    if (j <= first) early = std::max(early, std::abs(errors[j]));
    late = std::max(late, std::abs(errors[j]));
  }
  if (!(early > 0) || !(late < 0.1)) return {};
  return std::log(late / early) / std::log(static_cast<double>(last) / static_cast<double>(first));
}

/// The largest number of two digits that is not above x.
double two_digits(double x) {
  const double unit = std::pow(10, std::floor(std::log10(x)) - 1);
  return std::stod(fmt::format("{:.1e}", std::floor(x / unit * (1 + 1e-12)) * unit));
}

/// The trials of one candidate, and what they say about any step or tolerance.
class Fit {
 public:
  Fit(const Scene& scene, const Comparison& trials, const Candidate& who, Metric metric)
      : who_(who), rounding_(who.below_rounding ? rounding_of_two_words : least_fit) {
    for (const Row& row : trials.rows) {
      if (row.who == who && error_of(row, metric)) rows_.push_back(&row);
    }
    std::vector<std::pair<double, double>> errors, costs;
    for (const Row* row : rows_) {
      errors.emplace_back(x_of(*row), *error_of(*row, metric));
    }
    const double floor = std::max(rounding_, 3 * (metric == Metric::position ? trials.truth.error.value_or(0) : 0));
    law_ = asymptotic_fit(errors, floor, 0.5);
    if (!rows_.empty()) growth_ = growth(scene, trials, metric);
    chaos_ = metric == Metric::position && trials.motion && trials.motion->chaotic ? &*trials.motion : nullptr;
    if (chaos_ != nullptr) {
      growth_ = {0, fmt::format("the motion is chaotic: errors grow tenfold in {}", tenfold_in_words(*chaos_, scene))};
    }
  }

  /// Whether the trials show how the error depends on the step or the tolerance.
  bool tells() const { return law_.has_value(); }
  /// How many times as large as in the trials errors are at the end.
  double longer(double trial_end, double end) const {
    if (chaos_ != nullptr) return chaos_->factor(end) / chaos_->factor(trial_end);
    return std::pow(end / trial_end, growth_.exponent);
  }
  /// What holds an error over the whole run; empty where nothing tried tells.
  /// @param beyond  whether much finer settings count than those that were tried
  std::optional<Proposal> propose(double error, double trial_end, double end, bool beyond = false) const {
    if (!law_) return {};
    const double wanted = margin * error / longer(trial_end, end);
    if (wanted < rounding_) return {};
    if (chaos_ != nullptr && chaos_->rounding(end) * (rounding_ / least_fit) > margin * error) return {};
    double x = std::exp((std::log(wanted) - law_->log_factor) / law_->exponent);
    double most = 0, least = std::numeric_limits<double>::infinity();
    for (const Row* row : rows_) {
      most = std::max(most, x_of(*row));
      least = std::min(least, x_of(*row));
    }
    x = std::min(x, most);  // longer steps than any that was tried may be unstable
    if ((x < least / 4 && !beyond) || (who_.adaptive && x < 1e-15)) return {};
    if (!(end / x < most_steps) && !who_.adaptive) return {};
    if (who_.adaptive) x = two_digits(x);
    Proposal p{.who = who_, .growth = growth_, .order = law_->exponent};
    (who_.adaptive ? p.setting.tolerance : p.setting.step) = x;
    set_prediction(p, trial_end, end);
    return p;
  }

  /// The run with the smallest error, as a proposal for the whole run; none where nothing was measured.
  std::optional<std::pair<Proposal, double>> best(Metric metric, double trial_end, double end) const {
    const Row* least = nullptr;
    for (const Row* row : rows_) {
      if (least == nullptr || *error_of(*row, metric) < *error_of(*least, metric)) least = row;
    }
    if (least == nullptr) return {};
    const double error = *error_of(*least, metric), times = end / trial_end;
    Proposal p{.who = who_, .setting = least->setting, .growth = growth_, .order = law_ ? law_->exponent : 0};
    p.predicted_error = error * longer(trial_end, end);
    p.predicted_wall_s = least->wall_s.value_or(0) * times;
    p.predicted_evaluations = static_cast<double>(least->evaluations.force) * times;
    return std::pair(p, error);
  }

  /// Error and cost of a setting, over the whole run.
  void set_prediction(Proposal& p, double trial_end, double end) const {
    const double x = who_.adaptive ? p.setting.tolerance : p.setting.step;
    p.predicted_error = (*law_)(x)*longer(trial_end, end);
    const Row* near = rows_.front();
    for (const Row* row : rows_) {
      if (std::abs(std::log(x_of(*row) / x)) < std::abs(std::log(x_of(*near) / x))) near = row;
    }
    const double evaluations = static_cast<double>(near->evaluations.force) * cost_ratio(x, x_of(*near));
    p.predicted_evaluations = evaluations * end / trial_end;
    p.predicted_wall_s = near->wall_s.value_or(0) * cost_ratio(x, x_of(*near)) * end / trial_end;
  }

 private:
  double x_of(const Row& row) const { return who_.adaptive ? row.setting.tolerance : row.setting.step; }

  /// How much more a setting costs than another one.
  double cost_ratio(double x, double near) const {
    if (!who_.adaptive) return near / x;
    // Evaluations of an adaptive method are a power of its tolerance: the slope between the tolerances about x.
    const Row *above = nullptr, *below = nullptr;
    for (const Row* row : rows_) {
      if (x_of(*row) >= x && (above == nullptr || x_of(*row) < x_of(*above))) above = row;
      if (x_of(*row) < x && (below == nullptr || x_of(*row) > x_of(*below))) below = row;
    }
    if (above == nullptr || below == nullptr) {
      above = rows_[0];
      below = rows_.back();
    }
    if (above == below) return 1;
    const double slope =
        std::log(static_cast<double>(below->evaluations.force) / static_cast<double>(above->evaluations.force)) /
        std::log(x_of(*below) / x_of(*above));
    return std::pow(x / near, slope);
  }

  Growth growth(const Scene& scene, const Comparison& trials, Metric metric) const {
    const IntegratorClaims claims = assemble(variant(scene, who_, rows_.back()->setting)).claims();
    if (metric == Metric::energy && claims.symplectic)
      return {0, "the energy error of a symplectic method stays bounded"};
    std::vector<double> exponents;
    for (const Row* row : rows_) {
      if (*error_of(*row, metric) < 100 * rounding_) continue;
      if (const auto one = measured_exponent(*row, trials.truth, metric)) exponents.push_back(*one);
    }
    if (exponents.empty())
      return {metric == Metric::energy ? 1.0 : 2.0, "no growth could be measured; the usual growth is assumed"};
    std::sort(exponents.begin(), exponents.end());
    const double exponent = exponents[exponents.size() / 2];
    if (exponent < 1) return {1, fmt::format("errors grow at least linearly (measured: t^{:.2f})", exponent)};
    return {exponent, fmt::format("errors go on growing as they did in the trials, t^{:.2f}", exponent)};
  }

  Candidate who_;
  double rounding_;
  std::vector<const Row*> rows_;
  std::optional<PowerLaw> law_;
  Growth growth_;
  const Predictability* chaos_ = nullptr;  ///< of positions of a chaotic motion
};

/// @throws Error  where the trials tell no error of the metric
void check_measured(const Comparison& c, Metric metric) {
  if (metric == Metric::position && !c.position_measured) {
    const std::string limits = c.limits.empty() ? "" : c.limits + "; ";
    throw Error(fmt::format("positions cannot be measured here: {}{}; try --metric energy", limits, c.truth.note));
  }
  if (metric == Metric::position) return;
  const auto done = [](const Row& row) { return row.completed(); };
  const auto told = [](const Row& row) { return row.completed() && row.energy_error_max; };
  if (std::any_of(c.rows.begin(), c.rows.end(), done) && std::none_of(c.rows.begin(), c.rows.end(), told)) {
    throw Error("the energy cannot be measured here: not every force computes its own; try --metric position");
  }
}

/// Times that must be whole numbers of steps: the end, and what the scene asks for by time.
std::vector<double> times_to_meet(const Scene& scene, double end) {
  std::vector<double> times = {end};
  const SceneValue* every = scene.default_watches ? nullptr : scene.effective.find("every");
  const auto* tables = every == nullptr ? nullptr : every->get<SceneValue::Array>();
  for (std::size_t k = 0; tables != nullptr && k < tables->size() && k < scene.watches.size(); ++k) {
    for (const double time : scene.watches[k].cadence.times) {
      if (time != scene.integrator.start) times.push_back(time - scene.integrator.start);
    }
    if ((*tables)[k].find("every") == nullptr) continue;
    const Cadence& cadence = scene.watches[k].cadence;
    times.push_back(cadence.interval != 0 ? cadence.interval
                                          : static_cast<double>(cadence.steps) * scene.integrator.step);
  }
  return times;
}

/// The longest step, at most `step`, of which all times are whole numbers; `step` cut to the end where there is none.
double fitted_step(const std::vector<double>& times, double step, double end) {
  const double shortest = *std::min_element(times.begin(), times.end());
  const auto first = static_cast<std::int64_t>(std::ceil(shortest / step * (1 - 1e-12)));
  for (std::int64_t count = std::max<std::int64_t>(first, 1); count < first + 10'000; ++count) {
    const double one = shortest / static_cast<double>(count);
    const bool whole = std::all_of(times.begin(), times.end(), [&](double time) {
      const double exact = time / one;
      return std::abs(exact - std::round(exact)) < 1e-10 * exact;
    });
    if (whole) return one;
  }
  return end / std::ceil(end / step);
}

}  // namespace

namespace {

bool tells_energy(const Scene& scene) { return assemble(scene).claims().energy; }

/// Energy errors of a chaotic motion, as that of a liquid, are soon what they are all along: no row of the trials has
/// to take more than a quarter of its budget. @return when the trials end, by the clock; none: as comparisons do
std::optional<double> energy_trials_end(const Scene& scene, const AdviseOptions& options, Allowance& work) {
  const Sampling whole = sampling_of(scene, {});
  const double end = chaotic_energy_end(scene, whole, options.row_budget / 4, work);
  if (end >= whole.end()) return {};
  return whole.start + end;
}

/// Whether methods whose states have further digits than doubles are among the trials.
bool tries_two_words(const Scene& scene, const AdviseOptions& options) {
  if (options.methods.empty()) {
    return options.error < beyond_doubles && scene.particles.size() <= most_bodies &&
           !opponents_below_rounding(scene).empty();
  }
  return std::any_of(options.methods.begin(), options.methods.end(),
                     [&](const std::string& name) { return candidate(scene, name).below_rounding; });
}

/// One rounding of the finest states that are tried.
double finest_rounding(const Scene& scene, const AdviseOptions& options) {
  return one_rounding * (tries_two_words(scene, options) ? rounding_of_two_words / least_fit : 1);
}

/// Takes the metric that was asked for, or the one that can be held over the whole run.
void choose_metric(Advice& advice, const Scene& scene, const AdviseOptions& options, Allowance& work) {
  advice.metric = options.metric.value_or(Metric::position);
  if (options.metric || !tells_energy(scene)) return;
  std::function<void(double)> tell;
  if (options.progress) {
    tell = [&](double done) { options.progress({0, 1, done, "how fast small differences grow"}); };
    tell(0);
  }
  const auto motion =
      predictability(scene, sampling_of(scene, {}).end(), 4 * options.row_budget, work.left() / 4, tell, &work.spent);
  const bool liquid = scene.particles.box().is_periodic() || scene.particles.size() > most_bodies;
  if (motion && motion->unstable_step > 0) {
    advice.hints.push_back(fmt::format(
        "the step of the scene, {}, is unstable: runs that begin side by side part by it, but not by shorter steps",
        time_in_words(motion->unstable_step, scene)));
  }
  if (motion && !motion->judged && liquid) {
    advice.metric = Metric::energy;
    advice.trials_until = energy_trials_end(scene, options, work);
    advice.metric_reason =
        "errors are those of the energy: the budget does not tell how long positions can be held (--metric position "
        "tries)";
    return;
  }
  if (!motion || !motion->chaotic) return;
  const double finest = finest_rounding(scene, options);
  if (finest * motion->factor(advice.end) < 0.1 * options.error) return;
  advice.metric = Metric::energy;
  advice.trials_until = energy_trials_end(scene, options, work);
  advice.metric_reason = fmt::format(
      "errors are those of the energy: the motion is chaotic, small differences of positions grow tenfold "
      "in {}, so no run holds an error of {:g} of positions beyond a time of {} (--metric position tries)",
      tenfold_in_words(*motion, scene), options.error,
      time_in_words(std::min(motion->time_of(0.1 * options.error / finest), advice.end), scene));
}

/// Says why positions cannot be held, where the motion is why.
void tell_chaos(Advice& advice, const Scene& scene, const AdviseOptions& options) {
  const auto& motion = advice.trials.motion;
  if (advice.metric != Metric::position || !motion || !motion->chaotic) return;
  const double told = motion->time_of(margin * options.error / finest_rounding(scene, options));
  if (told >= advice.end) return;
  std::string hint = fmt::format(
      "no trajectory of this motion holds an error of {:g} of positions over {}: it is chaotic, small differences grow "
      "tenfold in {}, and roundings alone come to {:g} at a time of {}",
      options.error, time_in_words(advice.end, scene), tenfold_in_words(*motion, scene), options.error,
      time_in_words(told, scene));
  if (tells_energy(scene)) hint += "; the energy can be held: --metric energy";
  advice.hints.push_back(std::move(hint));
}

/// Names forces whose end at the cutoff no method of high order can be accurate over.
void tell_cutoffs(Advice& advice, const Scene& scene) {
  for (const SceneForce& force : scene.hamiltonian.forces) {
    const SceneValue* style = force.effective.find("cutoff_style");
    const std::string* text = style != nullptr ? style->get<std::string>() : nullptr;
    if (text == nullptr || *text == "switch_c4" || !(force.force.claims().range > 0)) continue;
    advice.hints.push_back(
        fmt::format("force '{0}' ends at its cutoff by \"{1}\", which is not smooth, and limits the order of every "
                    "method; try --set 'hamiltonian.force.{0}.cutoff_style=switch_c4'",
                    force.name, *text));
  }
}

/// What is there where nothing that was tried holds the error.
void tell_best(Advice& advice, const Scene& scene, const AdviseOptions& options, const std::vector<Fit>& fits) {
  for (const Fit& fit : fits) {
    const auto best = fit.best(advice.metric, advice.trial_end, advice.end);
    if (best && (!advice.best || best->first.predicted_error < advice.best->predicted_error)) {
      advice.best = best->first;
      advice.best_error = best->second;
    }
    auto beyond = fit.propose(options.error, advice.trial_end, advice.end, true);
    if (beyond && (!advice.would_hold || beyond->predicted_wall_s < advice.would_hold->predicted_wall_s))
      advice.would_hold = std::move(beyond);
  }
  tell_chaos(advice, scene, options);
  tell_cutoffs(advice, scene);
}

std::string reason_of(const Advice& advice, const AdviseOptions& options, bool tells) {
  const Comparison& c = advice.trials;
  if (!advice.left_out.empty()) return advice.left_out.front();
  if (!tells) {
    const bool vague =
        advice.metric == Metric::position && c.truth.error.value_or(0) > std::min(10 * least_fit, 0.1 * options.error);
    return "the trials do not tell how errors depend on the step; " +
           (vague ? fmt::format("the solution that they are measured against, {}, is known to {:.1e} only",
                                c.truth.name, *c.truth.error)
                  : std::string("a longer run would tell more"));
  }
  const std::string tried = c.methods.size() == 1 ? "the one method tried does not hold"
                                                  : fmt::format("none of the {} methods tried holds", c.methods.size());
  return fmt::format("{} an error of {:g} over the whole run", tried, options.error);
}

CompareOptions trials_of(const Scene& scene, const Advice& advice, const AdviseOptions& options,
                         const Allowance& work) {
  CompareOptions trials;
  trials.methods = options.methods;
  if (trials.methods.empty() && tries_two_words(scene, options)) {
    for (const Candidate& who : default_opponents(scene)) trials.methods.push_back(who.label);
    for (const Candidate& who : opponents_below_rounding(scene)) trials.methods.push_back(who.label);
  }
  trials.row_budget = options.row_budget;
  trials.truth = options.truth;
  trials.progress = options.progress;
  trials.positions = advice.metric == Metric::position;
  trials.quick = true;
  trials.until = advice.trials_until;
  trials.until_at_most = true;
  trials.work = work;
  trials.repeats = 1;
  return trials;
}

void check_request(const Scene& scene, const AdviseOptions& options) {
  refuse_noise(scene);
  if (!(options.error > 0 && options.error < 1)) {
    throw Error(fmt::format("an error of {} cannot be held; a number between 0 and 1 is expected", options.error));
  }
  if (options.metric == Metric::energy && scene.system && !tells_energy(scene)) {
    throw Error(fmt::format("the energy cannot be measured here: system '{}' has none; try --metric position",
                            scene.system->name));
  }
}

}  // namespace

Advice advise(const Scene& scene, const AdviseOptions& options) {
  check_request(scene, options);
  Advice advice;
  advice.end = end_of(scene);
  Allowance work = allowance_of(scene, sampling_of(scene, {}));
  choose_metric(advice, scene, options, work);
  advice.trials = compare(scene, trials_of(scene, advice, options, work));
  advice.trial_end = advice.trials.end;
  if (!options.metric && advice.metric == Metric::position && !advice.trials.position_measured && tells_energy(scene)) {
    advice.metric = Metric::energy;
    advice.metric_reason = "errors are those of the energy: nothing that was tried tells positions here";
  }
  check_measured(advice.trials, advice.metric);
  std::vector<Fit> fits;
  for (const Candidate& who : advice.trials.methods) fits.emplace_back(scene, advice.trials, who, advice.metric);
  for (const Fit& fit : fits) {
    auto proposal = fit.propose(options.error, advice.trial_end, advice.end);
    if (!proposal) continue;
    const Candidate& who = proposal->who;
    if (!who.adaptive) {
      const bool between = assemble(variant(scene, who, proposal->setting)).claims().between_steps;
      proposal->setting.step = fitted_step(between ? std::vector<double>{advice.end} : times_to_meet(scene, advice.end),
                                           proposal->setting.step, advice.end);
      fit.set_prediction(*proposal, advice.trial_end, advice.end);
    }
    SetLines lines = set_lines(scene, who, proposal->setting, advice.end);
    if (lines.refusal.empty()) {
      proposal->sets = std::move(lines.lines);
      advice.proposals.push_back(std::move(*proposal));
    } else {
      advice.left_out.push_back(
          fmt::format("{} holds it, but the scene refuses its lines: {}", who.label, lines.refusal));
    }
  }
  std::stable_sort(advice.proposals.begin(), advice.proposals.end(),
                   [](const Proposal& a, const Proposal& b) { return a.predicted_wall_s < b.predicted_wall_s; });
  if (!advice.proposals.empty()) {
    advice.sets = advice.proposals.front().sets;
    return advice;
  }
  const bool tells = std::any_of(fits.begin(), fits.end(), [](const Fit& fit) { return fit.tells(); });
  advice.reason = reason_of(advice, options, tells);
  tell_best(advice, scene, options, fits);
  return advice;
}

}  // namespace noether

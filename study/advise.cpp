#include "study/advise.hpp"

#include "numbers/quantity.hpp"
#include "scene/json.hpp"
#include "study/analysis.hpp"
#include "study/compare.hpp"
#include "study/set_lines.hpp"
#include "study/wide_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {

namespace {

constexpr double margin = 0.7;      ///< of the error that was asked for: fits scatter
constexpr double rounding = 1e-14;  ///< no fit is believed below

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
  if (errors.size() < 41) return {};
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
  Fit(const Scene& scene, const Comparison& trials, const Candidate& who, Metric metric) : who_(who) {
    for (const Row& row : trials.rows) {
      if (row.who == who && error_of(row, metric)) rows_.push_back(&row);
    }
    std::vector<std::pair<double, double>> errors, costs;
    for (const Row* row : rows_) {
      errors.emplace_back(x_of(*row), *error_of(*row, metric));
    }
    const double floor = std::max(rounding, 3 * (metric == Metric::position ? trials.truth.error.value_or(0) : 0));
    law_ = asymptotic_fit(errors, floor, 0.5);
    if (!rows_.empty()) growth_ = growth(scene, trials, metric);
  }

  /// Whether the trials show how the error depends on the step or the tolerance.
  bool tells() const { return law_.has_value(); }
  /// What holds an error over the whole run; empty where nothing tried tells.
  std::optional<Proposal> propose(double error, double trial_end, double end) const {
    if (!law_) return {};
    const double longer = std::pow(end / trial_end, growth_.exponent);
    const double wanted = margin * error / longer;
    if (wanted < rounding) return {};
    double x = std::exp((std::log(wanted) - law_->log_factor) / law_->exponent);
    double most = 0, least = std::numeric_limits<double>::infinity();
    for (const Row* row : rows_) {
      most = std::max(most, x_of(*row));
      least = std::min(least, x_of(*row));
    }
    x = std::min(x, most);  // longer steps than any that was tried may be unstable
    if (x < least / 4 || (who_.adaptive && x < 1e-15)) return {};
    if (who_.adaptive) x = two_digits(x);
    Proposal p{.who = who_, .growth = growth_};
    (who_.adaptive ? p.setting.tolerance : p.setting.step) = x;
    set_prediction(p, longer, trial_end, end);
    return p;
  }

  /// Error and cost of a setting, over the whole run.
  void set_prediction(Proposal& p, double longer, double trial_end, double end) const {
    const double x = who_.adaptive ? p.setting.tolerance : p.setting.step;
    p.predicted_error = (*law_)(x)*longer;
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
      if (*error_of(*row, metric) < 100 * rounding) continue;
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
  std::vector<const Row*> rows_;
  std::optional<PowerLaw> law_;
  Growth growth_;
};

/// @throws Error  where the trials tell no error of the metric
void check_measured(const Comparison& c, Metric metric) {
  if (metric == Metric::position && !c.position_measured) {
    throw Error(fmt::format("positions cannot be measured here: {}; try --metric energy", c.truth.note));
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
  const SceneValue* every = scene.effective.find("every");
  const auto* tables = every == nullptr ? nullptr : every->get<SceneValue::Array>();
  for (std::size_t k = 0; tables != nullptr && k < tables->size() && k < scene.watches.size(); ++k) {
    for (const double time : scene.watches[k].cadence.times) {
      if (time != scene.integrator.start) times.push_back(time - scene.integrator.start);
    }
    if ((*tables)[k].find("every") == nullptr) continue;
    times.push_back(static_cast<double>(scene.watches[k].cadence.steps) * scene.integrator.step);
  }
  return times;
}

/// The longest step, at most `step`, of which all times are whole numbers; `step` cut to the end where there is none.
double fitted_step(const Scene& scene, double step, double end) {
  const std::vector<double> times = times_to_meet(scene, end);
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

Advice advise(const Scene& scene, const AdviseOptions& options) {
  refuse_noise(scene);
  if (!(options.error > 0 && options.error < 1)) {
    throw Error(fmt::format("an error of {} cannot be held; a number between 0 and 1 is expected", options.error));
  }
  if (options.metric == Metric::energy && scene.system) {
    throw Error(fmt::format("the energy cannot be measured here: system '{}' has none; try --metric position",
                            scene.system->name));
  }
  Advice advice;
  advice.end = end_of(scene);
  CompareOptions trials;
  trials.methods = options.methods;
  trials.row_budget = options.row_budget;
  trials.truth = options.truth;
  trials.progress = options.progress;
  advice.trials = compare(scene, trials);
  const Comparison& c = advice.trials;
  advice.trial_end = c.end;
  check_measured(c, options.metric);
  bool tells = false;
  for (const Candidate& who : c.methods) {
    const Fit fit(scene, c, who, options.metric);
    tells = tells || fit.tells();
    auto proposal = fit.propose(options.error, advice.trial_end, advice.end);
    if (!proposal) continue;
    if (!who.adaptive) {
      proposal->setting.step = fitted_step(scene, proposal->setting.step, advice.end);
      fit.set_prediction(*proposal, std::pow(advice.end / advice.trial_end, proposal->growth.exponent),
                         advice.trial_end, advice.end);
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
  } else if (!advice.left_out.empty()) {
    advice.reason = advice.left_out.front();
  } else if (!tells) {
    const bool vague = options.metric == Metric::position && c.truth.error.value_or(0) > 10 * rounding;
    advice.reason = "the trials do not tell how errors depend on the step; " +
                    (vague ? fmt::format("the solution that they are measured against, {}, is known to {:.1e} only",
                                         c.truth.name, *c.truth.error)
                           : std::string("a longer run would tell more"));
  } else {
    const std::string tried = c.methods.size() == 1
                                  ? "the one method tried does not hold"
                                  : fmt::format("none of the {} methods tried holds", c.methods.size());
    advice.reason = fmt::format("{} an error of {:g} over the whole run", tried, options.error);
  }
  return advice;
}

std::string to_json(const Advice& a, const Scene& scene) {
  const bool any = !a.proposals.empty();
  const Proposal best = any ? a.proposals.front() : Proposal{};
  const auto number = [&](double x) { return any && x > 0 ? Json(x) : Json(); };
  std::vector<Json> others;
  for (const Proposal& p : a.proposals) {
    others.push_back(Json::object({{"method", p.who.label},
                                   {"step", p.who.adaptive ? Json() : Json(p.setting.step)},
                                   {"tolerance", p.who.adaptive ? Json(p.setting.tolerance) : Json()},
                                   {"predicted_error", p.predicted_error},
                                   {"predicted_wall_s", p.predicted_wall_s},
                                   {"predicted_evaluations", p.predicted_evaluations},
                                   {"growth_exponent", p.growth.exponent},
                                   {"assumption", p.growth.assumption}}));
  }
  return Json::object({{"schema", "noether.advise/1"},
                       {"scene", scene.source.file},
                       {"method", any ? Json(best.who.method) : Json()},
                       {"step", number(best.setting.step)},
                       {"step_unit", scene.units->time},
                       {"tolerance", number(best.setting.tolerance)},
                       {"predicted_error", number(best.predicted_error)},
                       {"predicted_wall_s", number(best.predicted_wall_s)},
                       {"predicted_evaluations", number(best.predicted_evaluations)},
                       {"assumption", any ? Json(best.growth.assumption) : Json()},
                       {"set", Json::list_of(a.sets)},
                       {"end", a.end},
                       {"trial_end", a.trial_end},
                       {"reason", a.reason.empty() ? Json() : Json(a.reason)},
                       {"left_out", Json::list_of(a.left_out)},
                       {"proposals", Json::list(others)}})
      .text();
}

std::string to_text(const Advice& a, const Scene& scene) {
  const std::string unit = scene.units->is_reduced() ? "" : " " + std::string(scene.units->time);
  std::string out =
      fmt::format("tried {}, {} over {:.6g}{}; the whole run is {:.6g}{}\n", counted(a.trials.methods.size(), "method"),
                  counted(a.trials.rows.size(), "run"), a.trial_end, unit, a.end, unit);
  if (a.proposals.empty()) return out + a.reason + "\n";
  out += fmt::format("{:<32} {:>12} {:>10} {:>12} {:>14}\n", "method", "step/rtol", "error", "time [s]", "evaluations");
  for (const Proposal& p : a.proposals) {
    out +=
        fmt::format("{:<32} {:>12} {:>10.1e} {:>12.3g} {:>14.4g}\n", p.who.label,
                    p.who.adaptive ? fmt::format("{:.1e}", p.setting.tolerance) : fmt::format("{:.5g}", p.setting.step),
                    p.predicted_error, p.predicted_wall_s, p.predicted_evaluations);
  }
  const Proposal& best = a.proposals.front();
  out += fmt::format("cheapest: {}; {}\n", best.who.label, best.growth.assumption);
  for (const std::string& one : a.left_out) out += one + "\n";
  for (const std::string& set : a.sets) out += fmt::format("--set '{}'\n", set);
  return out;
}

}  // namespace noether

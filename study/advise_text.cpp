#include "numbers/quantity.hpp"
#include "numbers/text.hpp"
#include "scene/json.hpp"
#include "study/advise.hpp"
#include "study/analysis.hpp"
#include "study/horizon.hpp"

#include <fmt/format.h>

namespace noether {

namespace {

Json json_of(const Proposal& p) {
  return Json::object({{"method", p.who.label},
                       {"step", p.who.adaptive ? Json() : Json(p.setting.step)},
                       {"tolerance", p.who.adaptive ? Json(p.setting.tolerance) : Json()},
                       {"predicted_error", p.predicted_error},
                       {"predicted_wall_s", p.predicted_wall_s},
                       {"predicted_evaluations", p.predicted_evaluations},
                       {"growth_exponent", p.growth.exponent},
                       {"assumption", p.growth.assumption}});
}

/// "verlet with a step of 0.001", "dop853 with rtol 1e-12".
std::string with_setting(const Proposal& p, const Scene& scene) {
  return p.who.adaptive ? fmt::format("{} with rtol {:.1e}", p.who.label, p.setting.tolerance)
                        : fmt::format("{} with a step of {}", p.who.label, time_in_words(p.setting.step, scene));
}

/// "1 evaluation", "3.907e+05 evaluations".
std::string evaluations_in_words(double count) {
  return count == 1 ? counted(1, "evaluation") : fmt::format("{:.4g} evaluations", count);
}

/// What was found, and what would do, where nothing that was tried holds the error.
std::string instead_of_proposals(const Advice& a, const Scene& scene) {
  std::string out;
  if (a.best) {
    const bool longer = a.end > a.trial_end * (1 + 1e-9);
    out += fmt::format("best found: {}: {} error {:.1e} over {}", with_setting(*a.best, scene),
                       a.metric == Metric::energy ? "energy" : "position", a.best_error,
                       time_in_words(a.trial_end, scene));
    if (longer && a.best->predicted_error < 0.1)
      out += fmt::format(", about {:.1e} over the whole run", a.best->predicted_error);
    if (longer && a.best->predicted_error >= 0.1) out += ", as large as what is computed over the whole run";
    out += fmt::format("; the whole run takes about {:.3g} s and {}\n", a.best->predicted_wall_s,
                       evaluations_in_words(a.best->predicted_evaluations));
  }
  if (a.would_hold) {
    const Proposal& p = *a.would_hold;
    out += fmt::format(
        "what should hold it: {}, finer than any that was tried: errors fall as its power {:.2g}; about "
        "{:.3g} s and {}\n",
        with_setting(p, scene), p.order, p.predicted_wall_s, evaluations_in_words(p.predicted_evaluations));
  }
  for (const std::string& hint : a.hints) out += hint + "\n";
  return out;
}

}  // namespace

std::string to_json(const Advice& a, const Scene& scene) {
  const bool any = !a.proposals.empty();
  const Proposal best = any ? a.proposals.front() : Proposal{};
  const auto number = [&](double x) { return any && x > 0 ? Json(x) : Json(); };
  std::vector<Json> others;
  for (const Proposal& p : a.proposals) others.push_back(json_of(p));
  return Json::object({{"schema", "noether.advise/1"},
                       {"scene", scene.source.file},
                       {"metric", a.metric == Metric::energy ? "energy" : "position"},
                       {"metric_reason", a.metric_reason.empty() ? Json() : Json(a.metric_reason)},
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
                       {"trial_evaluations", a.trials.work.spent},
                       {"reason", a.reason.empty() ? Json() : Json(a.reason)},
                       {"best", a.best ? json_of(*a.best) : Json()},
                       {"best_error", a.best ? Json(a.best_error) : Json()},
                       {"would_hold", a.would_hold ? json_of(*a.would_hold) : Json()},
                       {"hints", Json::list_of(a.hints)},
                       {"left_out", Json::list_of(a.left_out)},
                       {"proposals", Json::list(others)}})
      .text();
}

std::string to_text(const Advice& a, const Scene& scene) {
  const std::string unit = scene.units->is_reduced() ? "" : " " + std::string(scene.units->time);
  std::string out =
      fmt::format("tried {}, {} over {:.6g}{}; the whole run is {:.6g}{}\n", counted(a.trials.methods.size(), "method"),
                  counted(a.trials.rows.size(), "run"), a.trial_end, unit, a.end, unit);
  if (!a.metric_reason.empty()) out += a.metric_reason + "\n";
  if (!a.trials.limits.empty()) out += a.trials.limits + "\n";
  if (a.proposals.empty()) return out + a.reason + "\n" + instead_of_proposals(a, scene);
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
  for (const std::string& hint : a.hints) out += hint + "\n";
  for (const std::string& set : a.sets) out += fmt::format("--set '{}'\n", set);
  return out;
}

}  // namespace noether

#include "numbers/text.hpp"
#include "scene/json.hpp"
#include "study/stability.hpp"

#include <fmt/format.h>

namespace noether {

namespace {

std::string number(const std::optional<double>& x, int digits) { return x ? fmt::format("{:.{}g}", *x, digits) : "-"; }

Json json_of(const KeplerSteps& kepler) {
  std::vector<Json> resonances;
  for (int n = 1; kepler.period > 0 && n <= KeplerSteps::resonances; ++n) {
    resonances.push_back(Json::object({{"n", n}, {"step", kepler.resonance(n)}}));
  }
  return Json::object({{"shortest_period", kepler.period > 0 ? Json(kepler.period) : Json()},
                       {"shortest_period_of", kepler.period > 0 ? Json(kepler.period_of) : Json()},
                       {"pericenter_passage", kepler.passage},
                       {"pericenter_passage_of", kepler.passage_of},
                       {"step_resonances", Json::list(resonances)},
                       {"rule_longest_step", kepler.longest()}});
}

Json json_of(const TurningSteps& turning) {
  return Json::object({{"period", turning.period},
                       {"period_of", turning.body},
                       {"rotor", turning.rotor ? Json(std::string(rotor_name(*turning.rotor))) : Json()},
                       {"limit_step", Json(turning.limit())},
                       {"rule_recommended_step", Json(turning.recommended())}});
}

/// What the fastest turn asks of steps, by what turns bodies.
std::string turning_rule(const TurningSteps& turning, const std::string& unit) {
  if (!turning.recommended()) return "exact turns follow it at any step";
  const std::string rule =
      fmt::format("20 steps in it, at most {:.4g}{}, are a rule for ", *turning.recommended(), unit);
  if (turning.rotor == Rotor::axes) return rule + "turns axis by axis";
  if (!turning.rotor) return rule + "methods on the group of rotations";
  return rule +
         fmt::format("the variational rotor, which has no turn beyond steps of about {:.4g}{}", *turning.limit(), unit);
}

}  // namespace

std::string reason_text(const StabilityRow& row) {
  if (row.reason == "not_settled") return "not settled";
  std::string text = row.reason;
  if (row.resonance > 0) text += fmt::format(" {}:1", row.resonance);
  return row.settled ? text : text + ", not settled";
}

std::string limit_step_text(const StabilityRow& row, int digits, std::string_view none) {
  if (row.limit_step) return number(row.limit_step, digits);
  return row.bounded_step ? "> " + number(row.bounded_step, digits) : std::string(none);
}

std::vector<std::string> kepler_lines(const Stability& found) {
  if (!found.kepler) return {};
  const KeplerSteps& kepler = *found.kepler;
  const std::string unit = found.time_unit == "1" ? "" : " " + found.time_unit;
  std::vector<std::string> lines;
  if (kepler.period > 0) {
    std::string steps;
    for (int n = 1; n <= KeplerSteps::resonances; ++n)
      steps += fmt::format("{}{:.5g}", n > 1 ? ", " : "", kepler.resonance(n));
    lines.push_back(fmt::format("Kepler arcs resonate with the shortest period, {:.6g}{} of {}, at steps of {}{}",
                                kepler.period, unit, kepler.period_of, steps, unit));
  }
  lines.push_back(
      fmt::format("rule, no limit: 16 steps in the fastest passage of a pericenter, {:.6g}{} of {}: at most {:.4g}{}",
                  kepler.passage, unit, kepler.passage_of, kepler.longest(), unit));
  return lines;
}

std::vector<std::string> turning_lines(const Stability& found) {
  if (!found.turning) return {};
  const TurningSteps& turning = *found.turning;
  const std::string unit = found.time_unit == "1" ? "" : " " + found.time_unit;
  return {fmt::format("{} turns fastest, once in {:.6g}{}: {}", turning.body, turning.period, unit,
                      turning_rule(turning, unit))};
}

std::vector<std::string> growth_lines(const Stability& found) {
  if (!found.solution_leaves) return {};
  const std::string unit = found.time_unit == "1" ? "" : " " + found.time_unit;
  return {fmt::format(
      "the solution itself is 100 times as large as at the start after {:.5g}{}: runs are judged up to there",
      *found.solution_leaves, unit)};
}

std::string to_json(const Stability& found) {
  const auto time = [&](const std::optional<double>& x) { return Json(x); };
  std::vector<Json> rows;
  for (const StabilityRow& row : found.rows) {
    std::vector<Json> resonances;
    for (const auto& [n, z] : row.theory.resonances) {
      resonances.push_back(Json::object({{"n", n}, {"h_omega", z}}));
    }
    rows.push_back(Json::object({{"method", row.who.label},
                                 {"limit_step", time(row.limit_step)},
                                 {"limit_h_omega", Json(row.limit_h_omega)},
                                 {"theory", Json(row.theory.limit)},
                                 {"theory_known", row.theory.known},
                                 {"reason", row.reason},
                                 {"gap_end", Json(row.gap_end)},
                                 {"bounded_until", Json(row.bounded_until)},
                                 {"bounded_step", time(row.bounded_step)},
                                 {"recommended_step", time(row.recommended_step)},
                                 {"resonance", row.resonance > 0 ? Json(row.resonance) : Json()},
                                 {"resonances", Json::list(resonances)},
                                 {"settled", row.settled},
                                 {"message", row.message.empty() ? Json() : Json(row.message)},
                                 {"scan_steps", row.scan_steps},
                                 {"steps", row.steps},
                                 {"wall_s", row.seconds}}));
  }
  const auto positive = [](double x) { return x > 0 ? Json(x) : Json(); };
  return Json::object({{"schema", "noether.stability/1"},
                       {"scene", found.scene},
                       {"time_unit", found.time_unit},
                       {"omega", positive(found.spectrum.fastest)},
                       {"shortest_period", positive(found.spectrum.shortest_period())},
                       {"linear", found.linear},
                       {"solution_leaves", Json(found.solution_leaves)},
                       {"growth_threshold", found.growth_told},
                       {"theory_growth_threshold", growth_threshold},
                       {"kepler", found.kepler ? json_of(*found.kepler) : Json()},
                       {"turning", found.turning ? json_of(*found.turning) : Json()},
                       {"decorators", Json::list_of(found.decorators)},
                       {"rows", Json::list(rows)}})
      .text();
}

std::string to_text(const Stability& found) {
  const bool reduced = found.time_unit == "1";
  const std::string unit = reduced ? "" : " " + found.time_unit;
  std::string out;
  if (found.spectrum.fastest > 0) {
    out += fmt::format("fastest oscillation: omega = {:.6g}{}, period {:.6g}{}{}\n", found.spectrum.fastest,
                       reduced ? "" : " 1/" + found.time_unit, found.spectrum.shortest_period(), unit,
                       found.linear ? ", linear" : "");
  } else {
    out += "no oscillation is known; only steps are given\n";
  }
  for (const std::string& line : kepler_lines(found)) out += plain_line(line) + "\n";
  for (const std::string& line : turning_lines(found)) out += plain_line(line) + "\n";
  for (const std::string& line : growth_lines(found)) out += line + "\n";
  if (!found.decorators.empty()) {
    out += fmt::format("every method is wrapped by {}, so linear theory, which is for bare methods, is left out\n",
                       fmt::join(found.decorators, ", "));
  }
  out += fmt::format("{:<28} {:>12} {:>10} {:>10} {:<18} {:>10} {:>13} {:>7}\n", "method", "limit step", "h omega",
                     "theory", "reason", "gap end", "recommended", "s");
  for (const StabilityRow& row : found.rows) {
    const std::string theory = row.theory.limit ? number(row.theory.limit, 6) : row.theory.known ? "none" : "-";
    out += fmt::format("{:<28} {:>12} {:>10} {:>10} {:<18} {:>10} {:>13} {:>7.1f}\n", row.who.label,
                       limit_step_text(row, 6, "-"), number(row.limit_h_omega, 6), theory, reason_text(row),
                       number(row.gap_end, 6), number(row.recommended_step, 4), row.seconds);
  }
  if (found.linear && found.spectrum.fastest > 0) {
    out += fmt::format(
        "limits: growth from {:.2g} per step counts, in theory from {:.2g}; symplectic methods do not grow below their "
        "limits\n",
        found.growth_told, growth_threshold);
  }
  for (const StabilityRow& row : found.rows) {
    if (!row.message.empty()) out += fmt::format("{}: {}\n", row.who.label, row.message);
  }
  return out;
}

}  // namespace noether

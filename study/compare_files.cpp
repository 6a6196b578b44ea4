#include "study/compare_files.hpp"

#include "io/files.hpp"
#include "numbers/quantity.hpp"
#include "scene/json.hpp"
#include "study/analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace noether {

namespace {

using Cells = std::vector<std::pair<std::string_view, Json>>;

std::optional<double> above_zero(double x) { return x > 0 ? std::optional(x) : std::nullopt; }

Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

/// One row, column by column, in the order of the files.
Cells cells_of(const Comparison& c, const Row& row) {
  const Evaluations& e = row.evaluations;
  return {{"scene", c.scene},
          {"method", row.who.label},
          {"step", above_zero(row.setting.step)},
          {"step_unit", row.setting.step > 0 ? Json(c.time_unit) : Json()},
          {"tolerance", above_zero(row.setting.tolerance)},
          {"threads", c.threads},
          {"simd", c.simd},
          {"outcome", row.outcome},
          {"outcome_time", row.outcome_time},
          {"steps", row.steps},
          {"rejected", e.rejected},
          {"force_evaluations", e.force},
          {"kepler_evaluations", e.kepler},
          {"jacobian_evaluations", e.jacobian},
          {"wall_s", row.wall_s},
          {"wall_mad_s", row.wall_mad_s},
          {"repeats", row.repeats},
          {"position_error_max", row.position_error_max},
          {"position_error_rms", row.position_error_rms},
          {"position_error_end", row.position_error_end},
          {"energy_error_max", row.energy_error_max},
          {"energy_error_rms", row.energy_error_rms},
          {"energy_slope", row.energy_slope},
          {"energy_slope_error", row.energy_slope_error},
          {"momentum_error_max", row.momentum_error_max},
          {"angular_momentum_error_max", row.angular_momentum_error_max},
          {"shadow_fluctuation", row.shadow_fluctuation},
          {"truth", row.truth},
          {"truth_error", row.truth_error},
          {"pareto_time", row.pareto_time},
          {"pareto_evaluations", row.pareto_evaluations},
          {"digest", text_or_null(row.digest)},
          {"orientation_error_max", row.orientation_error_max}};
}

/// A cell of CSV: texts are quoted only where they must be, null is empty.
std::string csv_cell(const std::string& json) {
  if (json == "null") return "";
  if (json.size() < 2 || json[0] != '"') return json;
  const std::string text = json.substr(1, json.size() - 2);
  if (text.find_first_of(",\"\\") == std::string::npos) return text;
  std::string out = "\"";
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] == '\\' && k + 1 < text.size()) ++k;  // JSON writes '"' and '\' with a '\' before them
    if (text[k] == '"') out += '"';
    out += text[k];
  }
  return out + "\"";
}

Json file_of(const std::filesystem::path& file) { return file.empty() ? Json() : Json(file.string()); }

Json orders_of(const Comparison& c) {
  std::vector<Json> orders;
  for (const OrderFit& fit : c.orders) {
    orders.push_back(Json::object({{"method", fit.label},
                                   {"order", fit.order},
                                   {"order_error", fit.error},
                                   {"rows", fit.rows},
                                   {"against", fit.adaptive ? "evaluations" : "step"},
                                   {"of", fit.measured}}));
  }
  return Json::list(orders);
}

}  // namespace

std::string to_csv(const Comparison& c) {
  std::string out;
  for (const auto& [column, value] : cells_of(c, Row{})) out += (out.empty() ? "" : ",") + std::string(column);
  out += '\n';
  for (const Row& row : c.rows) {
    std::string line;
    for (const auto& [column, value] : cells_of(c, row)) {
      line += (column == "scene" ? "" : ",") + csv_cell(value.text());
    }
    out += line + '\n';
  }
  return out;
}

std::string to_json(const Comparison& c, const CompareFiles& files) {
  std::vector<Json> rows;
  for (const Row& row : c.rows) {
    Json::Members members;
    for (const auto& [column, value] : cells_of(c, row)) members.emplace_back(column, value);
    members.emplace_back("message", text_or_null(row.message));
    rows.push_back(Json::object(members));
  }
  return Json::object({{"schema", "noether.compare/1"},
                       {"version", c.version},
                       {"commit", c.commit},
                       {"command", text_or_null(c.command)},
                       {"date", c.date},
                       {"machine", c.machine},
                       {"scene", c.scene},
                       {"title", text_or_null(c.title)},
                       {"particles", std::int64_t{c.particles}},
                       {"time_unit", c.time_unit},
                       {"end", c.end},
                       {"scene_end", c.scene_end},
                       {"samples", c.sampling.samples},
                       {"limits", text_or_null(c.limits)},
                       {"truth", Json::object({{"name", c.truth.name},
                                               {"error", c.truth.error},
                                               {"note", c.truth.note},
                                               {"seconds", c.truth.seconds}})},
                       {"error", c.position_measured ? "position" : "energy"},
                       {"orders", orders_of(c)},
                       {"files", Json::object({{"csv", file_of(files.csv)},
                                               {"json", file_of(files.json)},
                                               {"report", file_of(files.report)}})},
                       {"rows", Json::list(rows)}})
      .text();
}

std::string to_text(const Comparison& c) {
  const std::string unit = c.time_unit == "1" ? "" : " " + c.time_unit;
  std::string out = fmt::format("{}, {} over {:.6g}{}", counted(c.methods.size(), "method"),
                                counted(c.rows.size(), "run"), c.end, unit);
  if (c.scene_end)
    out += fmt::format(" (the scene itself: {:.6g}{}; --until compares another time)", *c.scene_end, unit);
  if (!c.limits.empty()) out += "\n" + c.limits;
  out += fmt::format("\ntruth: {}", c.truth.name);
  if (c.truth.error) out += fmt::format(", good to {:.1e}", *c.truth.error);
  if (!c.truth.note.empty()) out += fmt::format(" ({})", c.truth.note);
  const auto turns = [](const Row& row) { return row.orientation_error_max.has_value(); };
  if (c.position_measured && std::any_of(c.rows.begin(), c.rows.end(), turns)) {
    out +=
        "\nposition errors are the angle [rad] by which the worst body is turned from the truth, where that is larger";
  }
  const char* kind = c.position_measured ? "position error" : "energy error";
  out += fmt::format("\n{:<32} {:>10} {:>9} {:>12} {:>10} {:>15}  {}\n", "method", "step/rtol", "time [s]",
                     "evaluations", "energy", kind, "fronts");
  for (const Row& row : c.rows) {
    const auto number = [](const std::optional<double>& x) { return x ? fmt::format("{:.1e}", *x) : std::string("-"); };
    const std::string setting =
        row.who.adaptive ? fmt::format("{:.0e}", row.setting.tolerance) : fmt::format("{:.4g}", row.setting.step);
    const std::string fronts = row.completed() ? fmt::format("{}{}", row.pareto_time ? "time " : "",
                                                             row.pareto_evaluations ? "evaluations" : "")
                                               : row.outcome;
    out += fmt::format("{:<32} {:>10} {:>9} {:>12} {:>10} {:>15}  {}\n", row.who.label, setting,
                       row.wall_s ? fmt::format("{:.3g}", *row.wall_s) : "-", row.evaluations.force,
                       number(row.energy_error_max), number(c.error_of(row)), fronts);
  }
  return out;
}

CompareFiles write_files(const Comparison& c, const std::filesystem::path& folder, const std::string& report) {
  io::make_folder(folder);
  const CompareFiles files{folder / "compare.csv", folder / "compare.json", folder / "report.html"};
  io::write_and_sync(files.csv, to_csv(c));
  io::write_and_sync(files.json, to_json(c, files) + "\n");
  io::write_and_sync(files.report, report);
  return files;
}

}  // namespace noether

#include "study/report.hpp"
#include "study/row_plot.hpp"
#include "study/stability.hpp"
#include "study/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

std::string digits(const std::optional<double>& x, const char* none = "") {
  return x ? fmt::format("{:.5g}", *x) : std::string(none);
}

/// Where theory lets a method fail: by growth, or by its solver.
std::optional<double> expected_limit(const LinearTheory& theory) { return theory.limit ? theory.limit : theory.solver; }

std::string theory_text(const StabilityRow& row) {
  return row.theory.known ? digits(expected_limit(row.theory), "none") : std::string("unknown");
}

/// What stands beside a row: "2", or "1.715, theory 2, resonance 3:1".
std::string limit_note(const StabilityRow& row, const std::optional<double>& limit) {
  std::string text = limit         ? digits(limit)
                     : row.settled ? "no limit found"
                                   : "bounded to " + digits(row.bounded_until, "?");
  if (!row.settled) text += ", not settled";
  if (differs_from_theory(row) || !row.theory.known) text += ", theory " + theory_text(row);
  if (row.reason == "resonance" || row.reason == "solver") text += ", " + row.reason;
  if (row.resonance > 0) text += fmt::format(" {}:1", row.resonance);
  return text;
}

std::string limits_of(const Stability& found, const std::string& unit) {
  const bool scaled = found.mode.scale() > 0;
  std::vector<LimitRow> rows;
  for (const StabilityRow& row : found.rows) {
    const std::optional<double> limit = scaled ? row.limit_h_omega : row.limit_step;
    std::vector<double> resonances;
    if (!found.linear) {
      for (const auto& [n, z] : row.theory.resonances) resonances.push_back(z);
    }
    rows.push_back({.label = row.who.label,
                    .measured = limit ? limit : row.bounded_until,
                    .theory = expected_limit(row.theory),
                    .theory_known = row.theory.known,
                    .settled = row.settled,
                    .differs = differs_from_theory(row),
                    .resonances = resonances,
                    .note = limit_note(row, limit)});
  }
  const std::string times = found.mode.lambda ? "h |\u03bb|" : "h \u03c9";
  return limits_svg(scaled ? "largest stable " + times : "largest stable step" + unit, rows) + limits_key();
}

std::string figures_of(const Stability& found, const std::string& unit) {
  std::string out = fmt::format(
      "<h2>Figures</h2>\n<div class=\"scroll\"><table>\n<tr><th>method</th><th>limit step{0}</th><th>h \u03c9</th>"
      "<th>theory</th><th>reason</th><th>bounded again from</th><th>recommended step{0}</th><th>steps</th></tr>\n",
      html_text(unit));
  for (const StabilityRow& row : found.rows) {
    out += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td{}>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        html_text(row.who.label), html_text(limit_step_text(row, 5, "")), digits(row.limit_h_omega), theory_text(row),
        differs_from_theory(row) ? " class=\"bad\"" : "", reason_text(row), digits(row.gap_end),
        digits(row.recommended_step), row.steps);
  }
  return out + "</table></div>\n";
}

}  // namespace

bool differs_from_theory(const StabilityRow& row) {
  if (!row.theory.known || !row.settled) return false;
  const std::optional<double> measured = row.limit_h_omega, theory = expected_limit(row.theory);
  if (!measured || !theory) return measured.has_value() != theory.has_value();
  return std::abs(*measured / *theory - 1) > 0.01;
}

std::string to_html(const Stability& found) {
  const bool reduced = found.time_unit == "1";
  const std::string unit = reduced ? "" : " [" + found.time_unit + "]";
  std::string body;
  if (found.spectrum.fastest > 0) {
    body += fmt::format("<p class=\"lead\">Fastest oscillation: \u03c9 = {:.6g}{}, period {:.6g}{}{}.</p>\n",
                        found.spectrum.fastest, reduced ? "" : " 1/" + html_text(found.time_unit),
                        found.spectrum.shortest_period(), reduced ? "" : " " + html_text(found.time_unit),
                        found.linear ? "; the problem is linear" : "");
  }
  for (const std::string& line : kepler_lines(found)) body += "<p class=\"lead\">" + html_text(line) + ".</p>\n";
  for (const std::string& line : turning_lines(found)) body += "<p class=\"lead\">" + html_text(line) + ".</p>\n";
  for (const std::string& line : growth_lines(found)) body += "<p class=\"lead\">" + html_text(line) + ".</p>\n";
  body += limits_of(found, unit) + figures_of(found, unit);
  std::string messages;
  for (const StabilityRow& row : found.rows) {
    if (!row.message.empty()) messages += html_text(row.who.label + ": " + row.message) + "<br>\n";
  }
  if (!messages.empty()) body += "<p class=\"lead\">" + messages + "</p>\n";
  return html_page("Largest stable steps: " + (found.title.empty() ? found.scene : found.title), body);
}

}  // namespace noether

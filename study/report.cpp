#include "study/report.hpp"

#include "numbers/quantity.hpp"
#include "scene/json.hpp"
#include "study/analysis.hpp"
#include "study/plot.hpp"
#include "study/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

/// The name of a method in plots: a dagger stands for the other Hamiltonian.
std::string short_label(const Candidate& who) {
  const std::size_t at = who.label.find('@');
  return at == std::string::npos ? who.label : who.label.substr(0, at) + " \u2020";
}

std::string number(const std::optional<double>& x, const char* none = "") {
  return x ? fmt::format("{:.2e}", *x) : std::string(none);
}

std::string with_unit(const std::string& unit, const char* before = " ") { return unit == "1" ? "" : before + unit; }

class Page {
 public:
  Page(const Comparison& c, const std::optional<Solution>& solution) : c_(c), solution_(solution) {
    unit_ = with_unit(c.time_unit);
  }

  std::string text() const {
    const std::string title = c_.title.empty() ? c_.scene : c_.title;
    return html_page("What accuracy costs: " + title,
                     lead() + costs() + orders() + over_time() + solution() + rows() + colophon());
  }

 private:
  const char* error_name() const {
    return c_.position_measured ? "largest relative error of positions" : "largest relative error of the energy";
  }

  int style_of(const Candidate& who) const {
    return static_cast<int>(std::find(c_.methods.begin(), c_.methods.end(), who) - c_.methods.begin());
  }

  std::string lead() const {
    const auto particles = static_cast<std::size_t>(c_.particles);
    std::string out =
        fmt::format("<p class=\"lead\">{}, {}, {} over {:.6g}{}", counted(particles, "particle"),
                    counted(c_.methods.size(), "method"), counted(c_.rows.size(), "run"), c_.end, html_text(unit_));
    if (c_.scene_end) out += fmt::format(", the first part of the scene's {:.6g}{}", *c_.scene_end, html_text(unit_));
    out += fmt::format(". Every run is compared at the same {} moments.</p>\n<p>", c_.sampling.samples);
    if (c_.truth.kind == TruthKind::quad || c_.truth.kind == TruthKind::doubles) {
      out += fmt::format("The reference is computed in {} by two runs that agree to {:.1e}: {}.",
                         c_.truth.kind == TruthKind::quad ? "extended precision (113 bits)" : "double precision",
                         c_.truth.error.value_or(0), html_text(c_.truth.note));
      if (!c_.limits.empty()) out += " " + html_text(c_.limits) + ".";
    } else if (c_.truth.kind == TruthKind::finest_run) {
      out += fmt::format("There is no reference in extended precision: {}.", html_text(c_.truth.note));
    } else {
      out += fmt::format("There is no reference: {}. Methods are compared by how well they conserve energy.",
                         html_text(c_.truth.note));
    }
    if (c_.particles == 0) {
      out +=
          " The error of a system is the root mean square over its variables, each relative to the largest it ever is.";
    }
    return out + "</p>\n";
  }

  ChartCurve curve_of(const Candidate& who, bool by_time) const {
    ChartCurve curve{.label = short_label(who), .style = style_of(who), .dashed = who.adaptive};
    for (const Row& row : c_.rows) {
      const auto error = c_.error_of(row);
      if (!(row.who == who) || !row.completed() || !error) continue;
      const double cost = by_time ? row.wall_s.value_or(0) : static_cast<double>(row.evaluations.force);
      curve.points.emplace_back(cost, *error);
      curve.ringed.push_back(by_time ? row.pareto_time : row.pareto_evaluations);
    }
    return curve;
  }

  std::string costs() const {
    std::string out;
    for (const bool by_time : {true, false}) {
      std::vector<ChartCurve> curves;
      for (const Candidate& who : c_.methods) curves.push_back(curve_of(who, by_time));
      out += fmt::format("<h2>Error against {}</h2>\n", by_time ? "run time" : "evaluations of the forces");
      out += plot_svg(
          {.x = by_time ? "wall time of the run alone [s], median" : "evaluations of the forces", .y = error_name()},
          curves);
    }
    out +=
        "<p class=\"lead\">Rings and the broad line: the front, beaten by no other run in both. Solid, filled: fixed "
        "steps. Dashed, hollow: steps chosen by a tolerance.";
    const bool dagger = std::any_of(c_.methods.begin(), c_.methods.end(),
                                    [&](const Candidate& who) { return who.label.find('@') != std::string::npos; });
    if (dagger)
      out +=
          " \u2020: on kinetic_potential, the whole gravity as one kick; unmarked schemes run on the scene's own "
          "splitting, "
          "whose Kepler arcs are not counted as evaluations.";
    return out + "</p>\n";
  }

  std::string orders() const {
    std::string out =
        "<h2>Orders</h2>\n<p class=\"lead\">Slope of the error over the rows between coarse steps and rounding: "
        "against the step, for adaptive methods against the step that evaluations tell.</p>\n<div "
        "class=\"scroll\"><table>\n"
        "<tr><th>method</th><th>order</th><th>\u00b1</th><th>rows</th><th>smallest error</th><th>its time "
        "[s]</th></tr>\n";
    for (const OrderFit& fit : c_.orders) {
      const auto who = std::find_if(c_.methods.begin(), c_.methods.end(),
                                    [&](const Candidate& one) { return one.label == fit.label; });
      const Row* best = best_row(*who);
      out += fmt::format(
          "<tr data-name=\"{}\"><td>{}{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
          html_text(short_label(*who)), marker_svg(style_of(*who), who->adaptive), html_text(fit.label),
          fit.order ? fmt::format("{:.2f}", *fit.order) : "", fit.error ? fmt::format("{:.2f}", *fit.error) : "",
          fit.rows > 0 ? std::to_string(fit.rows) : "", best ? number(c_.error_of(*best)) : "",
          best && best->wall_s ? fmt::format("{:.3g}", *best->wall_s) : "");
    }
    return out + "</table></div>\n";
  }

  const Row* best_row(const Candidate& who) const {
    const Row* best = nullptr;
    for (const Row& row : c_.rows) {
      const auto error = c_.error_of(row);
      if (!(row.who == who) || !row.completed() || !error) continue;
      if (best == nullptr || *error < *c_.error_of(*best)) best = &row;
    }
    return best;
  }

  /// Largest absolute value in each of about fifty blocks: what oscillates becomes a line that can be read.
  static std::vector<std::pair<double, double>> envelope(const Track& track, const std::vector<double>& values) {
    std::vector<std::pair<double, double>> points;
    const std::size_t block = std::max<std::size_t>(1, values.size() / 50);
    for (std::size_t begin = 1; begin + block <= values.size(); begin += block) {
      double worst = 0;
      for (std::size_t k = begin; k < begin + block; ++k) worst = std::max(worst, std::abs(values[k]));
      points.emplace_back(static_cast<double>(track.times[begin + block - 1]), std::max(worst, 1e-24));
    }
    return points;
  }

  std::string over_time() const {
    std::vector<ChartCurve> energies, positions;
    for (const Candidate& who : c_.methods) {
      const Row* best = best_row(who);
      if (best == nullptr) continue;
      ChartCurve curve{.label = short_label(who), .style = style_of(who), .dashed = who.adaptive, .markers = false};
      curve.points = envelope(best->track, energy_errors(best->track, c_.truth));
      if (!curve.points.empty()) energies.push_back(curve);
      curve.points = envelope(best->track, best->position_errors);
      if (!curve.points.empty()) positions.push_back(curve);
    }
    std::string out;
    const std::string time = "time" + with_unit(c_.time_unit, " [") + (c_.time_unit == "1" ? "" : "]");
    if (!energies.empty()) {
      out += "<h2>Energy error over time</h2>\n" +
             plot_svg({.x = time, .y = "relative error of the energy", .log_x = false}, energies);
    }
    if (!positions.empty()) {
      out += "<h2>Position error over time</h2>\n" +
             plot_svg({.x = time, .y = "relative error of positions", .log_x = false}, positions);
    }
    if (!out.empty())
      out +=
          "<p class=\"lead\">For each method the run with its smallest error; largest value in blocks of "
          "moments.</p>\n";
    return out;
  }

  std::string solution() const {
    if (!solution_) return "";
    const Solution& s = *solution_;
    std::string out = "<h2>The solution itself</h2>\n<div class=\"panel\">\n";
    const auto slider = [](const char* id, std::size_t count, std::size_t at) {
      return fmt::format(
          "<label>{0} <input type=\"range\" id=\"{0}\" min=\"0\" max=\"{1}\" value=\"{2}\"> <output "
          "id=\"{0}-said\"></output></label>\n",
          id, count - 1, at);
    };
    out += slider("method", s.methods.size(), 0) +
           slider("step", s.steps.size(), std::min<std::size_t>(3, s.steps.size() - 1));
    if (s.dampings.size() > 1) out += slider("damping", s.dampings.size(), s.own_damping);
    out +=
        "<svg class=\"plot\" id=\"solution\" viewBox=\"0 0 1000 524\" role=\"img\" aria-label=\"the "
        "solution\"></svg>\n</div>\n";
    out +=
        "<p class=\"lead\">Above: exact (broad, grey) and by the method (red). Below: its energy error, "
        "relative.</p>\n";
    return out + "<script type=\"application/json\" id=\"solution-data\">" + solution_json() + "</script>\n";
  }

  /// The runs of the display, in as few digits as can be seen.
  std::string solution_json() const {
    const Solution& s = *solution_;
    const auto digits = [](const std::vector<double>& values) {
      std::vector<Json> all;
      for (const double x : values) all.emplace_back(std::stod(fmt::format("{:.5g}", x)));
      return Json::list(all);
    };
    std::vector<Json> exact, runs;
    for (const ExactMotion& one : s.exact) exact.push_back(Json::object({{"t", digits(one.t)}, {"q", digits(one.q)}}));
    for (const DisplayedRun& run : s.runs) {
      runs.push_back(Json::object({{"m", static_cast<std::int64_t>(run.method)},
                                   {"h", static_cast<std::int64_t>(run.step)},
                                   {"d", static_cast<std::int64_t>(run.damping)},
                                   {"refused", run.refused},
                                   {"t", digits(run.t)},
                                   {"q", digits(run.q)},
                                   {"e", digits(run.energy_error)}}));
    }
    std::string text = Json::object({{"methods", Json::list_of(s.methods)},
                                     {"steps", digits(s.steps)},
                                     {"dampings", digits(s.dampings)},
                                     {"omega", s.omega},
                                     {"coordinate", std::string(1, s.coordinate)},
                                     {"unit", unit_},
                                     {"per_unit", with_unit(c_.time_unit, " per ")},
                                     {"time_unit", with_unit(c_.time_unit, " [") + (c_.time_unit == "1" ? "" : "]")},
                                     {"length_unit", ""},
                                     {"exact", Json::list(exact)},
                                     {"runs", Json::list(runs)}})
                           .text();
    for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3) text.replace(at, 2, "<\\/");
    return text;
  }

  std::string rows() const {
    std::string out =
        "<h2>All runs</h2>\n<div class=\"scroll\"><table>\n<tr><th>method</th><th>step" +
        html_text(with_unit(c_.time_unit, ", ")) +
        "</th><th>rtol</th><th>steps</th><th>evaluations</th><th>time [s]</th><th>\u00b1</th><th>position, max</th>"
        "<th>position, end</th><th>energy, max</th><th>energy slope</th><th>angular momentum</th><th>front</th></tr>\n";
    const Candidate* last = nullptr;
    for (const Row& row : c_.rows) {
      const bool begins = last == nullptr || !(*last == row.who);
      last = &row.who;
      const bool front = row.pareto_time || row.pareto_evaluations;
      const std::string fronts = !row.completed()                            ? row.outcome
                                 : row.pareto_time && row.pareto_evaluations ? "both"
                                 : row.pareto_time                           ? "time"
                                 : row.pareto_evaluations                    ? "evaluations"
                                                                             : "";
      out += fmt::format(
          "<tr class=\"{}{}\"><td>{}{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>",
          begins ? "group " : "", front ? "front" : "", begins ? marker_svg(style_of(row.who), row.who.adaptive) : "",
          begins ? html_text(row.who.label) : "", row.who.adaptive ? "" : fmt::format("{:.5g}", row.setting.step),
          row.who.adaptive ? fmt::format("{:.0e}", row.setting.tolerance) : "", row.steps, row.evaluations.force,
          row.wall_s ? fmt::format("{:.3g}", *row.wall_s) : "",
          row.wall_mad_s ? fmt::format("{:.0e}", *row.wall_mad_s) : "");
      out += fmt::format("<td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td{}>{}</td></tr>\n",
                         number(row.position_error_max), number(row.position_error_end), number(row.energy_error_max),
                         number(row.energy_slope), number(row.angular_momentum_error_max),
                         row.completed() ? "" : " class=\"bad\"", fronts);
    }
    return out + "</table></div>\n";
  }

  std::string colophon() const {
    std::string out = "<h2>How this was made</h2>\n<dl>\n";
    const auto line = [&](const char* name, const std::string& value) {
      out += fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, html_text(value));
    };
    if (!c_.command.empty()) out += fmt::format("<dt>command</dt><dd><code>{}</code></dd>\n", html_text(c_.command));
    line("scene", c_.scene);
    line("program", fmt::format("noether {} ({})", c_.version, c_.commit));
    line("machine", fmt::format("{}; {} {}, SIMD level {}", c_.machine, c_.threads,
                                c_.threads == 1 ? "thread" : "threads", c_.simd));
    line("date", c_.date);
    line("times", "medians of the runs alone, without monitors; errors come from runs of their own, of the same bits");
    line(
        "positions",
        "norm(x - x*)/norm(x*) over all bodies about the centre of mass; bodies in an outer field where they stand, "
        "relative to the rms of norm(x*); of rigid bodies the angle [rad] by which the worst is turned from the truth, "
        "where that is larger");
    line("energy",
         "(E - E0)/max(|E0|, 1e-3 (T0 + |U0|)); where the equations change the energy themselves, E* of the reference "
         "stands for E0");
    line("diverged",
         fmt::format("not finite, or {:.0e} times as large as the reference ever is; {:.0e} times as large as at "
                     "the start where there is no truth",
                     lost_beyond_truth, lost_beyond_start));
    line("tolerances",
         "rtol as given; atol in the scene's own ratio to it, if it gives one, and of a system else a thousandth, in "
         "the units of the scene");
    return out + "</dl>\n";
  }

  const Comparison& c_;
  const std::optional<Solution>& solution_;
  std::string unit_;
};

}  // namespace

std::string report_html(const Comparison& comparison, const std::optional<Solution>& solution) {
  return Page(comparison, solution).text();
}

}  // namespace noether

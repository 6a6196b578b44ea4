#include "study/row_plot.hpp"

#include "study/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

constexpr double character_width = 7.2, bold_width = 8;  ///< of the plots' font, on the generous side

template <class Row> double width_of(const std::vector<Row>& rows, std::string Row::*text) {
  std::size_t longest = 0;
  for (const Row& row : rows) longest = std::max(longest, (row.*text).size());
  return 16 + bold_width * static_cast<double>(longest);
}

/// Opens an SVG that is shown no larger than it is meant.
std::string opened_svg(double width, double height, const char* what) {
  return fmt::format(
      "<svg class=\"plot\" viewBox=\"0 0 {0:.0f} {1:.0f}\" style=\"max-width:{0:.0f}px\" role=\"img\" "
      "aria-label=\"{2}\">",
      width, height, what);
}

std::string opened_row(const std::string& label, bool alarm, double x, double y) {
  return fmt::format(
      "<g class=\"row{0}\" data-name=\"{1}\"><text class=\"series\" x=\"{2:.1f}\" y=\"{3:.1f}\" "
      "text-anchor=\"end\">{1}</text>",
      alarm ? " alarm" : "", html_text(label), x, y + 4);
}

std::string finding_mark(Finding finding, bool expected, double x, double y) {
  const char* colour = !expected                                                    ? "var(--c1)"
                       : finding == Finding::kept || finding == Finding::inaccurate ? "var(--c0)"
                                                                                    : "var(--soft)";
  switch (finding) {
    case Finding::kept:
      return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"{}\"/>", x, y, colour);
    case Finding::inaccurate:
      return fmt::format(
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.3\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\"/>", x, y,
          colour);
    case Finding::unbounded:
      return fmt::format("<path d=\"M{0:.1f} {1:.1f}l8 8m0 -8l-8 8\" fill=\"none\" stroke=\"{2}\" stroke-width=\"2\"/>",
                         x - 4, y - 4, colour);
    case Finding::unsolved:
      return fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"8\" height=\"8\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\"/>",
          x - 4, y - 4, colour);
    case Finding::unsettled:
      break;
  }
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" style=\"fill:{}\">?</text>", x, y + 4.5,
                     colour);
}

/// The cell behind what was not expected.
std::string alarm_cell(double x, double y) {
  return fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"18\" height=\"18\" rx=\"3\" fill=\"var(--c1)\" fill-opacity=\"0.2\" "
      "stroke=\"var(--c1)\"/>",
      x - 9, y - 9);
}

std::string swatch(const std::string& mark) { return "<svg class=\"swatch\" viewBox=\"0 0 20 20\">" + mark + "</svg>"; }

/// From 0, or logarithmic; none where no limit and no resonance is known.
std::optional<AxisRange> axis_of(const std::vector<LimitRow>& rows) {
  AxisRange all;
  const auto take = [&](double x) {
    if (x > 0 && std::isfinite(x)) all.take(x);
  };
  for (const LimitRow& row : rows) {
    if (row.measured) take(*row.measured);
    if (row.theory) take(*row.theory);
    for (const double z : row.resonances) take(z);
  }
  if (!(all.low <= all.high)) return {};
  all.log = all.high >= 10 * all.low;
  if (all.log) {
    all.widen();
  } else {
    all.low = 0;
    all.high *= 1.1;
  }
  return all;
}

/// One row of limits between x0 and x1.
std::string limit_row(const LimitRow& row, const AxisRange& range, double x0, double x1, double y) {
  const auto place = [&](const std::optional<double>& limit) {
    return limit && *limit > 0 ? x0 + range.at(*limit) * (x1 - x0) : limit ? x0 : x1;
  };
  const char* colour = row.differs ? "var(--c1)" : "var(--c0)";
  const double found = place(row.measured), expected = place(row.theory);
  std::string out = opened_row(row.label, row.differs, x0 - 8, y);
  out += fmt::format(
      "<path d=\"M{:.1f} {:.1f}H{:.1f}\" fill=\"none\" stroke=\"{}\" stroke-width=\"5\" stroke-opacity=\"0.3\"/>", x0,
      y, found, colour);
  if (row.differs) {
    out += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" fill=\"none\" stroke=\"{}\" stroke-dasharray=\"3 3\"/>",
                       found, y, expected, colour);
  }
  if (row.theory_known) {
    out += fmt::format(
        "<path class=\"theory\" d=\"M{0:.1f} {1:.1f}{2}\" fill=\"none\" stroke=\"var(--ink)\" "
        "stroke-width=\"2\"/>",
        expected, y - 8, row.theory ? "v16" : "l7 8l-7 8");
  }
  for (const double z : row.resonances) {
    out += fmt::format("<circle class=\"resonance\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.2\" fill=\"var(--soft)\"/>",
                       place(z), y);
  }
  const std::string style = fmt::format("class=\"measured\" fill=\"{}\" stroke=\"{}\" stroke-width=\"1.8\"",
                                        row.settled ? colour : "var(--page)", colour);
  out += row.measured ? fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.3\" {}/>", found, y, style)
                      : fmt::format("<path d=\"M{:.1f} {:.1f}l7 5l-7 5z\" {}/>", found - 12, y - 5, style);
  return out + fmt::format("<text class=\"note\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text></g>", x1 + 18, y + 4,
                           html_text(row.note));
}

}  // namespace

std::string verdicts_svg(const std::vector<std::string>& columns, const std::vector<VerdictRow>& rows) {
  constexpr double line = 20, pitch = 26, slope = 40 * M_PI / 180;
  std::size_t longest = 0;
  for (const std::string& column : columns) longest = std::max(longest, column.size());
  const double along = character_width * static_cast<double>(longest), left = width_of(rows, &VerdictRow::label);
  const double top = 20 + along * std::sin(slope);
  const double across = pitch * static_cast<double>(columns.size());
  const double width = left + across + along * std::cos(slope), height = top + line * static_cast<double>(rows.size());
  const auto px = [&](std::size_t column) { return left + pitch * (static_cast<double>(column) + 0.5); };
  std::string out = opened_svg(width, height + 4, "verdicts, method by method");
  for (std::size_t c = 0; c < columns.size(); ++c) {
    out += fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\"/>", px(c),
                       top - 6, height);
    out += fmt::format("<text class=\"name\" transform=\"translate({:.1f} {:.1f}) rotate(-40)\">{}</text>", px(c) + 3,
                       top - 10, html_text(columns[c]));
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double y = top + line * (static_cast<double>(r) + 0.5);
    const bool alarm =
        std::any_of(rows[r].marks.begin(), rows[r].marks.end(), [](const VerdictMark& mark) { return !mark.expected; });
    out += fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{2:.1f}\" y2=\"{1:.1f}\"/>", left, y,
                       left + across);
    out += opened_row(rows[r].label, alarm, left - 8, y);
    for (const VerdictMark& mark : rows[r].marks) {
      out +=
          fmt::format("<g class=\"verdict{}\"><title>{}</title>", mark.expected ? "" : " alarm", html_text(mark.title));
      if (!mark.expected) out += alarm_cell(px(mark.column), y);
      out += finding_mark(mark.finding, mark.expected, px(mark.column), y) + "</g>";
    }
    out += "</g>";
  }
  return out + "</svg>\n";
}

std::string verdicts_key() {
  std::string out = "<p class=\"key\">";
  for (const auto& [finding, meaning] :
       {std::pair(Finding::kept, "kept"), std::pair(Finding::inaccurate, "bounded, an error beyond its bound"),
        std::pair(Finding::unbounded, "unbounded"), std::pair(Finding::unsolved, "a step could not be solved"),
        std::pair(Finding::unsettled, "not settled in its time")}) {
    out += fmt::format("<span>{}{}</span>\n", swatch(finding_mark(finding, true, 10, 10)), meaning);
  }
  return out + fmt::format("<span>{}red: not what was expected</span></p>\n",
                           swatch(alarm_cell(10, 10) + finding_mark(Finding::unbounded, false, 10, 10)));
}

std::string limits_svg(const std::string& axis, const std::vector<LimitRow>& rows) {
  constexpr double width = 1000, top = 12, line = 24;
  const double left = width_of(rows, &LimitRow::label), x1 = width - 12 - width_of(rows, &LimitRow::note);
  const double bottom = top + line * static_cast<double>(rows.size());
  const std::optional<AxisRange> known = axis_of(rows);
  const AxisRange range = known.value_or(AxisRange{0, 1, false});
  std::string out = opened_svg(width, bottom + 48, "largest stable steps, method by method");
  for (const double x : known ? ticks_of(range, 8) : std::vector<double>()) {
    const double at = left + range.at(x) * (x1 - left);
    out += fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\"/>", at, top,
                       bottom);
    out += fmt::format("<text class=\"tick\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", at,
                       bottom + 17, tick_text(range, x));
  }
  out += fmt::format("<path class=\"axis\" d=\"M{:.1f} {:.1f}V{:.1f}H{:.1f}\"/>", left, top, bottom, x1);
  out += fmt::format("<text class=\"name\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", (left + x1) / 2,
                     bottom + 40, html_text(axis));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    out += limit_row(rows[r], range, left, x1, top + line * (static_cast<double>(r) + 0.5));
  }
  return out + "</svg>\n";
}

std::string limits_key() {
  const auto stroke = [](const char* path) {
    return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"var(--ink)\" stroke-width=\"2\"/>", path);
  };
  const auto disc = [](const char* fill, const char* edge) {
    return fmt::format("<circle cx=\"10\" cy=\"10\" r=\"4.3\" fill=\"{}\" stroke=\"{}\" stroke-width=\"1.8\"/>", fill,
                       edge);
  };
  return fmt::format(
      "<p class=\"key\"><span>{}measured</span>\n<span>{}not settled in its time</span>\n<span>{}linear theory</span>\n"
      "<span>{}no limit</span>\n<span>{}n:1 resonances of a step with the fastest oscillation</span>\n<span>{}red: "
      "measured and theory differ</span></p>\n",
      swatch(disc("var(--c0)", "var(--c0)")), swatch(disc("var(--page)", "var(--c0)")), swatch(stroke("M10 2v16")),
      swatch(stroke("M6 2l7 8l-7 8")), swatch("<circle cx=\"10\" cy=\"10\" r=\"2.2\" fill=\"var(--soft)\"/>"),
      swatch(disc("var(--c1)", "var(--c1)")));
}

}  // namespace noether

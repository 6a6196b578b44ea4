#include "scene/json.hpp"
#include "study/report.hpp"
#include "study/row_plot.hpp"
#include "study/suite.hpp"
#include "study/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

namespace noether {

namespace {

std::string stem(const SuiteRow& row) { return std::filesystem::path(row.scene).stem().string(); }

std::string changes(const SuiteRow& row) { return fmt::format("{}", fmt::join(row.sets, " ")); }

std::string figures(const SuiteRow& row) {
  std::string text = row.found;
  if (row.energy_error) text += fmt::format(", energy {:.1e}", *row.energy_error);
  if (row.sharing_error) text += fmt::format(", sharing {:.2g}", *row.sharing_error);
  return text;
}

Finding finding_of(const SuiteRow& row) {
  if (row.found == name(Bounded::unbounded)) return Finding::unbounded;
  if (row.found == name(Bounded::solver)) return Finding::unsolved;
  if (row.found == name(Bounded::unsettled)) return Finding::unsettled;
  return row.accurate ? Finding::kept : Finding::inaccurate;
}

/// The changes of a verdict as briefly as they are told apart: "step = 0.1", "inner.mass = 1e-3"; the method stands in
/// front of its row.
std::string short_changes(const std::vector<std::string>& sets) {
  const auto tail = [](std::string_view set, int names) {
    const std::string_view key = set.substr(0, set.find('='));
    std::size_t dot = key.size();
    for (int k = 0; k < names && dot != std::string_view::npos; ++k) dot = key.rfind('.', dot - 1);
    return dot == std::string_view::npos ? key : key.substr(dot + 1);
  };
  std::string text;
  for (const std::string& set : sets) {
    if (set.starts_with("integrator.method=")) continue;
    const auto same = [&](const std::string& other) { return tail(other, 1) == tail(set, 1); };
    const bool alone = std::count_if(sets.begin(), sets.end(), same) == 1;
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", tail(set, alone ? 1 : 2), set.substr(set.find('=') + 1));
  }
  return text.empty() ? "as in the scene" : text;
}

/// The rows of one scene as a picture: a column for every change, or more where a method is asked twice under it.
class VerdictTable {
 public:
  void add(const SuiteRow& row) {
    auto of_method =
        std::find_if(rows_.begin(), rows_.end(), [&](const VerdictRow& r) { return r.label == row.method; });
    if (of_method == rows_.end()) of_method = rows_.insert(rows_.end(), {.label = row.method});
    const std::string column = short_changes(row.sets);
    std::size_t c = 0;
    const auto taken = [&](const VerdictMark& mark) { return mark.column == c; };
    while (c < columns_.size() &&
           (columns_[c] != column || std::any_of(of_method->marks.begin(), of_method->marks.end(), taken)))
      ++c;
    if (c == columns_.size()) columns_.push_back(column);
    of_method->marks.push_back(
        {.column = c,
         .finding = finding_of(row),
         .expected = row.agrees,
         .title = fmt::format("{}, {}: expected {}; found {}", row.method, column, row.expected, figures(row))});
  }
  /// Columns of one change stand side by side.
  std::string svg() const {
    std::vector<std::size_t> order(columns_.size()), place(columns_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto first = [&](std::size_t c) { return std::find(columns_.begin(), columns_.end(), columns_[c]); };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return first(a) < first(b); });
    std::vector<std::string> columns;
    for (const std::size_t c : order) {
      place[c] = columns.size();
      columns.push_back(columns_[c]);
    }
    std::vector<VerdictRow> rows = rows_;
    for (VerdictRow& row : rows) {
      for (VerdictMark& mark : row.marks) mark.column = place[mark.column];
    }
    return verdicts_svg(columns, rows);
  }

 private:
  std::vector<std::string> columns_;
  std::vector<VerdictRow> rows_;
};

/// One scene: its picture, and its rows in figures.
std::string section(const SuiteRow* begin, const SuiteRow* end) {
  VerdictTable picture;
  std::string rows;
  for (const SuiteRow* row = begin; row != end; ++row) {
    picture.add(*row);
    rows +=
        fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td{}>{}</td><td>{:.1f}</td><td>{}</td></tr>\n",
                    html_text(row->method), html_text(changes(*row)), html_text(row->expected),
                    row->agrees ? "" : " class=\"bad\"", html_text(figures(*row)), row->seconds, html_text(row->why));
  }
  return fmt::format(
      "<h2>{}</h2>\n{}<details><summary>figures</summary>\n<div class=\"scroll\"><table class=\"words\">\n"
      "<tr><th>method</th><th>changes</th><th>expected</th><th>found</th><th>s</th><th>why</th></tr>\n{}</table></div>"
      "</details>\n",
      html_text(begin->title), picture.svg(), rows);
}

}  // namespace

std::string to_json(const Suite& suite) {
  std::vector<Json> rows;
  const auto text = [](const std::string& t) { return t.empty() ? Json() : Json(t); };
  for (const SuiteRow& row : suite.rows) {
    rows.push_back(Json::object({{"scene", stem(row)},
                                 {"title", row.title},
                                 {"method", row.method},
                                 {"set", text(changes(row))},
                                 {"expected", row.expected},
                                 {"found", row.found},
                                 {"agrees", row.agrees},
                                 {"h_omega", Json(row.h_omega)},
                                 {"energy_error", Json(row.energy_error)},
                                 {"sharing_error", Json(row.sharing_error)},
                                 {"why", text(row.why)},
                                 {"message", text(row.message)},
                                 {"steps", row.steps},
                                 {"wall_s", row.seconds}}));
  }
  return Json::object({{"schema", "noether.stability_suite/1"},
                       {"verdicts", static_cast<std::int64_t>(suite.rows.size())},
                       {"agreeing", static_cast<std::int64_t>(suite.agreeing())},
                       {"rows", Json::list(rows)}})
      .text();
}

std::string to_text(const Suite& suite) {
  std::string out, scene;
  for (const SuiteRow& row : suite.rows) {
    if (row.scene != scene) out += fmt::format("{}: {}\n", stem(row), row.title);
    scene = row.scene;
    out += fmt::format("  {} {:<26} {:<44} expected {:<28} found {} ({:.1f} s)\n", row.agrees ? "ok  " : "FAIL",
                       row.method, changes(row), row.expected, figures(row), row.seconds);
    if (!row.agrees && !row.message.empty()) out += fmt::format("       {}\n", row.message);
  }
  return out + fmt::format("{} of {} verdicts hold\n", suite.agreeing(), suite.rows.size());
}

std::string to_html(const Suite& suite) {
  std::string body =
      fmt::format("<p>{} of {} verdicts hold.</p>\n", suite.agreeing(), suite.rows.size()) + verdicts_key();
  const SuiteRow* const end = suite.rows.data() + suite.rows.size();
  for (const SuiteRow* row = suite.rows.data(); row != end;) {
    const SuiteRow* const next = std::find_if(row, end, [&](const SuiteRow& r) { return r.scene != row->scene; });
    body += section(row, next);
    row = next;
  }
  return html_page("Stability suite", body);
}

}  // namespace noether

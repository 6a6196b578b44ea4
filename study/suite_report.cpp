#include "scene/json.hpp"
#include "study/suite.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace noether {

namespace {

std::string stem(const SuiteRow& row) { return std::filesystem::path(row.scene).stem().string(); }

std::string figures(const SuiteRow& row) {
  std::string text = row.found;
  if (row.energy_error) text += fmt::format(", energy {:.1e}", *row.energy_error);
  if (row.sharing_error) text += fmt::format(", sharing {:.2g}", *row.sharing_error);
  return text;
}

std::string html(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '&') {
      out += "&amp;";
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace

std::string to_json(const Suite& suite) {
  std::vector<Json> rows;
  const auto text = [](const std::string& t) { return t.empty() ? Json() : Json(t); };
  for (const SuiteRow& row : suite.rows) {
    rows.push_back(Json::object({{"scene", stem(row)},
                                 {"title", row.title},
                                 {"method", row.method},
                                 {"set", text(row.sets)},
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
                       row.method, row.sets, row.expected, figures(row), row.seconds);
    if (!row.agrees && !row.message.empty()) out += fmt::format("       {}\n", row.message);
  }
  return out + fmt::format("{} of {} verdicts hold\n", suite.agreeing(), suite.rows.size());
}

std::string to_html(const Suite& suite) {
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>noether: stability "
      "suite</title>\n<style>\n"
      "body { font: 15px/1.45 system-ui, sans-serif; max-width: 75rem; margin: 2rem auto; padding: 0 1rem; }\n"
      "table { border-collapse: collapse; width: 100%; margin-bottom: 2rem; font-variant-numeric: tabular-nums; }\n"
      "th, td { text-align: left; padding: .2rem .7rem .2rem 0; border-bottom: 1px solid #ddd; vertical-align: top; }\n"
      ".no { color: #b00020; font-weight: 600; }\n</style></head><body>\n<h1>Stability suite</h1>\n";
  out += fmt::format("<p>{} of {} verdicts hold.</p>\n", suite.agreeing(), suite.rows.size());
  std::string scene;
  for (const SuiteRow& row : suite.rows) {
    if (row.scene != scene) {
      if (!scene.empty()) out += "</table>\n";
      out += fmt::format(
          "<h2>{}</h2>\n<table><tr><th>method</th><th>changes</th><th>expected</th><th>found</th>"
          "<th>why</th><th>s</th></tr>\n",
          html(row.title));
      scene = row.scene;
    }
    out += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td{}>{}</td><td>{}</td><td>{:.1f}</td></tr>\n",
                       html(row.method), html(row.sets), html(row.expected), row.agrees ? "" : " class=\"no\"",
                       html(figures(row)), html(row.why), row.seconds);
  }
  if (!scene.empty()) out += "</table>\n";
  return out + "</body></html>\n";
}

}  // namespace noether

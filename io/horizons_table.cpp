#include "io/horizons_table.hpp"

#include "numbers/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

namespace noether::io {

namespace {

/// A line without what a spreadsheet has put behind it, to give all lines as many fields.
std::string_view without_padding(std::string_view line) {
  line = trimmed(line);
  while (line.ends_with(';') || line.ends_with(',')) line = trimmed(line.substr(0, line.size() - 1));
  return line;
}

constexpr std::string_view table_start = "$$SOE", table_end = "$$EOE";

/// What stands between "label :" and a remark in braces, if the line begins with the label.
std::optional<std::string> value_after(std::string_view line, std::string_view label) {
  line = trimmed(line);
  if (!line.starts_with(label)) return {};
  line = trimmed(line.substr(label.size()));
  if (!line.starts_with(':')) return {};
  return std::string(trimmed(line.substr(1, line.find('{') - 1)));
}

/// "Jupiter Barycenter (5)": the number in the last parentheses, if it is one.
HorizonsObject object_of(const std::string& text) {
  HorizonsObject object{.text = text, .name = text, .number = {}};
  const std::size_t open = text.rfind('('), close = text.rfind(')');
  if (open == std::string::npos || close == std::string::npos || close < open) return object;
  int number = 0;
  const char* first = text.data() + open + 1;
  const auto [end, problem] = std::from_chars(first, text.data() + close, number);
  if (problem != std::errc() || end != text.data() + close) return object;
  object.number = number;
  object.name = trimmed(std::string_view(text).substr(0, open));
  return object;
}

/// One name for each frame: until 2021 Horizons said the plane on a line of its own.
std::string frame_of(const std::string& frame, const std::string& plane) {
  const bool icrf = frame.starts_with("ICRF");
  if (plane.empty()) return icrf ? "ICRF" : frame;
  if (icrf && plane == "Ecliptic and Mean Equinox of Reference Epoch") return "Ecliptic of J2000.0";
  if (icrf && plane == "Earth Mean Equator and Equinox of Reference Epoch") return "ICRF";
  return frame.empty() ? plane : frame + ", " + plane;
}

/// "TDB" of a heading "JDTDB", "JDTDB," or "JDTDB;"; empty if a line is none. CT was the name of TDB.
std::string time_scale_of(std::string_view line) {
  line = trimmed(line);
  line = trimmed(line.substr(0, line.find_first_of(",;\t")));
  if (!line.starts_with("JD") || line.size() < 4 || line.size() > 6) return "";
  line.remove_prefix(2);
  const auto is_capital = [](char c) { return c >= 'A' && c <= 'Z'; };
  if (!std::all_of(line.begin(), line.end(), is_capital)) return "";
  return line == "CT" ? "TDB" : std::string(line);
}

/// Reads the head of one table, line by line.
class HeadReader {
 public:
  HeadReader(const TextFile& text, const UnitSystem& units) : text_(text), units_(units) {}

  void read(std::size_t line) {
    const std::string content(without_padding(text_.lines()[line - 1]));
    if (trimmed(content).starts_with("Date__(")) {
      text_.fail(line, "this is a table of observations; ask Horizons for vectors (EPHEM_TYPE = VECTORS)");
    }
    if (const auto target = value_after(content, "Target body name")) {
      table_.target_line = line;
      table_.target = object_of(*target);
    }
    if (const auto center = value_after(content, "Center body name")) table_.center = object_of(*center);
    if (const auto site = value_after(content, "Center-site name")) check_site(line, *site);
    if (const auto frame = value_after(content, "Reference frame")) frame_ = *frame;
    if (const auto plane = value_after(content, "Coordinate systm")) plane_ = *plane;
    if (const auto units = value_after(content, "Output units")) table_.units = units->substr(0, units->find(','));
    if (const auto type = value_after(content, "Output type")) check_type(line, *type);
    if (const std::string scale = time_scale_of(content); !scale.empty()) table_.time_scale = scale;
    if (const auto mass = mass_of_line(line, "mass")) table_.mass = mass;
    if (const auto mass = mass_of_line(line, "center mass")) table_.center_mass = mass;
  }

  HorizonsTable take() {
    table_.frame = frame_of(frame_, plane_);
    return std::move(table_);
  }

 private:
  /// States must be those of one moment: others are where light shows a body that has moved on since.
  void check_type(std::size_t line, const std::string& type) const {
    if (type.find("elements") != std::string::npos) {
      text_.fail(line, "this is a table of elements; ask Horizons for vectors (EPHEM_TYPE = VECTORS)");
    }
    if (type.starts_with("GEOMETRIC")) return;
    text_.fail(
        line,
        fmt::format("the states of {} are '{}', not geometric; ask Horizons for states without corrections for light "
                    "time and aberration (VEC_CORR = NONE)",
                    table_.target.name, type),
        type);
  }

  void check_site(std::size_t line, const std::string& site) const {
    static constexpr std::array<std::string_view, 3> centers = {"BODY CENTER", "BODYCENTRIC", "GEOCENTRIC"};
    if (std::find(centers.begin(), centers.end(), site) != centers.end()) return;
    text_.fail(
        line,
        fmt::format("the states of {} are about the site '{}', which rotates with its body; ask Horizons for "
                    "the center of the body (CENTER = '500@{}')",
                    table_.target.name, site, table_.center.number ? std::to_string(*table_.center.number) : "0"),
        site);
  }

  /// A line "mass [kg] = 1.9e27" that a user has put in.
  std::optional<double> mass_of_line(std::size_t line, std::string_view name) const {
    const std::string_view content = trimmed(text_.lines()[line - 1]);
    const std::size_t equals = content.find_first_of("=:");
    if (!content.starts_with(name) || equals == std::string_view::npos) return {};
    const Heading heading = parse_heading(trimmed(content.substr(0, equals)));
    if (heading.name != name || !heading.unit) return {};
    return mass_in(text_, units_, line, heading, trimmed(content.substr(equals + 1)));
  }

  const TextFile& text_;
  const UnitSystem& units_;
  HorizonsTable table_;
  std::string frame_, plane_;
};

/// What separates the fields of a table: commas as Horizons writes them, semicolons or tabs as spreadsheets do; nothing
/// where records are text. `headings` is the last line before the records. @throws SceneError  for blanks
std::optional<char> separator_of(const TextFile& text, std::size_t line, std::string_view headings) {
  if (headings.find(',') != std::string_view::npos) return ',';
  if (!headings.starts_with("JD")) return {};
  for (const char separator : {';', '\t'}) {
    if (headings.find(separator) != std::string_view::npos) return separator;
  }
  if (headings.find(' ') != std::string_view::npos) {
    text.fail(line,
              "the fields of this table are separated by blanks, but its dates contain blanks too; separate them "
              "by commas, as Horizons does, or by semicolons or tabs");
  }
  return {};
}

}  // namespace

std::optional<HorizonsTable> next_horizons_table(const TextFile& text, const UnitSystem& units, std::size_t line) {
  const std::vector<std::string>& lines = text.lines();
  HeadReader head(text, units);
  std::string_view last_text;
  std::size_t last_line = 0;
  for (; line <= lines.size(); ++line) {
    const std::string_view content = trimmed(lines[line - 1]);
    if (without_padding(content) == table_start) break;
    head.read(line);
    if (without_padding(content).empty() || content.front() == '*') continue;
    last_text = content;
    last_line = line;
  }
  if (line > lines.size()) return {};
  HorizonsTable table = head.take();
  table.start = line;
  while (line <= lines.size() && without_padding(lines[line - 1]) != table_end) ++line;
  if (line > lines.size()) text.fail(table.start, "the table that begins here has no end: '$$EOE' is missing");
  table.end = line;
  if (table.target_line == 0) text.fail(table.start, "the header of this table has no line 'Target body name'");
  if (const auto separator = separator_of(text, last_line, last_text)) {
    table.separator = *separator;
    table.headings = split_at(last_text, *separator);
  }
  return table;
}

double mass_in(const TextFile& text, const UnitSystem& units, std::size_t line, const Heading& heading,
               std::string_view word) {
  try {
    const Unit unit = parse_unit(heading.unit.value_or("1"), units);
    if (unit.dimension == dimensions::mass) return unit.times(mass_number_in(text, line, word, "the mass"));
  } catch (const SceneError&) {
    throw;
  } catch (const Error& error) {
    text.fail(line, "mass: " + error.message());
  }
  text.fail(line, fmt::format("the mass is in '{}'; expected a unit of mass, such as 'mass [kg]'",
                              heading.unit.value_or("1")));
}

bool is_horizons(const TextFile& text) {
  return std::any_of(text.lines().begin(), text.lines().end(),
                     [](const std::string& line) { return without_padding(line) == table_start; });
}

}  // namespace noether::io

// Bodies from CSV: columns by name, units in brackets, positions and velocities or elements.
#include "engine/orbital_elements.hpp"
#include "io/text_table.hpp"
#include "numbers/quantity.hpp"
#include "numbers/suggest.hpp"
#include "numbers/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <set>
#include <utility>

namespace noether::io {

namespace {

/// What a table may hold; `dimension` in words, "" for what is no number.
struct KnownColumn {
  std::string_view name, dimension;
};
constexpr std::array known_columns = {
    KnownColumn{"name", ""},       KnownColumn{"id", ""},         KnownColumn{"mass", "mass"},
    KnownColumn{"x", "length"},    KnownColumn{"y", "length"},    KnownColumn{"z", "length"},
    KnownColumn{"vx", "velocity"}, KnownColumn{"vy", "velocity"}, KnownColumn{"vz", "velocity"},
    KnownColumn{"a", "length"},    KnownColumn{"e", "1"},         KnownColumn{"inc", "angle"},
    KnownColumn{"Omega", "angle"}, KnownColumn{"omega", "angle"}, KnownColumn{"M", "angle"},
};
constexpr std::array<std::string_view, 6> cartesian = {"x", "y", "z", "vx", "vy", "vz"};
constexpr std::array<std::string_view, 6> elements = {"a", "e", "inc", "Omega", "omega", "M"};

/// A line without its comment, cut at commas; commas and '#' in double quotes do not count.
std::vector<std::string> fields_of(const TextFile& text, std::size_t line) {
  const std::string& content = text.lines()[line - 1];
  std::vector<std::string> fields(1);
  bool quoted = false, was_quoted = false;
  const auto end_field = [&] {
    if (!was_quoted) fields.back() = trimmed(fields.back());
    was_quoted = false;
  };
  for (std::size_t i = 0; i < content.size(); ++i) {
    const char c = content[i];
    if (quoted) {
      const bool doubled = c == '"' && i + 1 < content.size() && content[i + 1] == '"';
      if (c == '"' && !doubled) quoted = false;
      if (c != '"' || doubled) fields.back() += c;
      if (doubled) ++i;
    } else if (c == '#') {
      break;
    } else if (c == ',') {
      end_field();
      fields.emplace_back();
    } else if (c == '"') {
      if (was_quoted || !trimmed(fields.back()).empty()) {
        text.fail(line,
                  "a double quote stands inside a field; quote the whole field, and write \"\" for a quote in it");
      }
      fields.back().clear();
      quoted = was_quoted = true;
    } else if (!was_quoted) {
      fields.back() += c;
    } else if (c != ' ' && c != '\t') {
      text.fail(line, fmt::format("'{}' follows the double quote that ends a field; expected a comma", c));
    }
  }
  if (quoted) text.fail(line, "a double quote is not closed on this line");
  end_field();
  if (fields.size() == 1 && fields[0].empty() && !was_quoted) return {};
  return fields;
}

/// A CSV table of bodies, read line by line.
class CsvBodies {
 public:
  CsvBodies(const TextFile& text, const UnitSystem& units, double G)
      : text_(text), units_(units), G_(G), bodies_(text, units) {}

  ParticleSystem<double> read() {
    for (std::size_t line = 1; line <= text_.lines().size(); ++line) {
      const std::vector<std::string> fields = fields_of(text_, line);
      if (fields.empty()) continue;
      if (heading_line_ == 0) {
        read_headings(line, fields);
      } else {
        read_row(line, fields);
      }
    }
    if (heading_line_ == 0) {
      text_.fail(0, "the table is empty; expected a line of column names, such as 'name,mass [Msun],x [au],...'");
    }
    if (bodies_.particles().size() == 0) text_.fail(heading_line_, "the table has column names, but no bodies");
    ParticleSystem<double> particles = bodies_.take();
    if (!ids_.empty()) particles.restore_ids(ids_);
    return particles;
  }

 private:
  struct Column {
    std::size_t field;
    std::optional<Unit> unit;
  };

  void read_headings(std::size_t line, const std::vector<std::string>& fields) {
    heading_line_ = line;
    field_count_ = fields.size();
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const Heading heading = parse_heading(fields[k]);
      const KnownColumn& known = known_column(line, k, heading.name);
      const bool is_new = columns_.try_emplace(heading.name, Column{k, {}}).second;
      if (!is_new) text_.fail(line, fmt::format("column '{}' stands twice", heading.name), heading.name);
      if (!known.dimension.empty()) {
        columns_.at(heading.name).unit = unit_of_column(line, heading, known.dimension);
      } else if (heading.unit) {
        text_.fail(line, fmt::format("column '{}' takes no unit, not '{}'", heading.name, *heading.unit),
                   *heading.unit);
      }
    }
    check_columns(line);
  }

  const KnownColumn& known_column(std::size_t line, std::size_t field, const std::string& name) const {
    std::vector<std::string> names;
    for (const KnownColumn& known : known_columns) {
      if (known.name == name) return known;
      names.emplace_back(known.name);
    }
    if (name.empty()) text_.fail(line, fmt::format("column {} has no name", field + 1));
    text_.fail(line, fmt::format("unknown column '{}'{}", name, did_you_mean(name, names)), name);
  }

  Unit unit_of_column(std::size_t line, const Heading& heading, std::string_view words) const {
    const Dimension expected = parse_dimension(words);
    const bool bare = units_.is_reduced() || words == "1";
    if (!heading.unit || (units_.is_reduced() && *heading.unit == "1")) {
      if (bare) return parse_unit("1", units_);
      const std::string example = words == "angle" ? "deg" : noether::unit_of(expected, units_);
      text_.fail(line,
                 fmt::format("column '{0}' has no unit; write '{0} [{1}]' or another unit of {2}", heading.name,
                             example, words),
                 heading.name);
    }
    Unit unit;
    try {
      unit = parse_unit(*heading.unit, units_);
    } catch (const Error& error) {
      text_.fail(line, fmt::format("column '{}': {}", heading.name, error.message()), *heading.unit);
    }
    if (unit.dimension != expected) {
      text_.fail(line,
                 fmt::format("column '{}' is in '{}', which is of dimension {}; expected {}", heading.name,
                             *heading.unit, to_text(unit.dimension), words),
                 *heading.unit);
    }
    return unit;
  }

  bool has(std::string_view name) const { return columns_.count(std::string(name)) != 0; }

  void check_columns(std::size_t line) {
    const auto present = [&](std::string_view name) { return has(name); };
    const auto x = std::find_if(cartesian.begin(), cartesian.end(), present);
    const auto a = std::find_if(elements.begin(), elements.end(), present);
    if (x != cartesian.end() && a != elements.end()) {
      text_.fail(line, fmt::format("columns '{}' and '{}' are of two kinds; give positions and velocities, or elements",
                                   *x, *a));
    }
    by_elements_ = a != elements.end();
    std::vector<std::string_view> missing;
    if (!has("mass")) missing.push_back("mass");
    for (const std::string_view name : by_elements_ ? elements : cartesian) {
      if (!has(name)) missing.push_back(name);
    }
    if (missing.empty()) return;
    text_.fail(line, fmt::format("there is no column {}; expected mass and {}", fmt::join(missing, ", "),
                                 by_elements_ ? "a, e, inc, Omega, omega, M"
                                              : "x, y, z, vx, vy, vz, or the elements a, e, inc, Omega, omega, M"));
  }

  void read_row(std::size_t line, const std::vector<std::string>& fields) {
    if (fields.size() != field_count_) {
      text_.fail(line, fmt::format("this row has {} fields; expected {}, as line {} names", fields.size(), field_count_,
                                   heading_line_));
    }
    const Index row = bodies_.particles().size();
    std::string name = fmt::format("body_{}", row + 1);
    if (has("name")) name = fields[columns_.at("name").field];
    const std::string wrong = wrong_name(name);
    if (!wrong.empty()) text_.fail(line, wrong, name);
    read_id(line, fields);
    const double mass = number(line, fields, "mass");
    auto [x, v] = by_elements_ ? state_by_elements(line, fields, name, mass, row == 0) : state(line, fields);
    bodies_.add(line, name, mass, x, v);
  }

  void read_id(std::size_t line, const std::vector<std::string>& fields) {
    if (!has("id")) return;
    const std::string& word = fields[columns_.at("id").field];
    std::int64_t id = -1;
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), id);
    constexpr std::int64_t largest = ParticleSystem<double>::largest_id;
    if (problem != std::errc() || end != word.data() + word.size() || id < 0 || id > largest) {
      text_.fail(line, fmt::format("column 'id' is '{}'; expected a whole number from 0 to {}", word, largest), word);
    }
    if (!known_ids_.insert(id).second) text_.fail(line, fmt::format("the id {} is taken; ids must differ", id), word);
    ids_.push_back(id);
  }

  double number(std::size_t line, const std::vector<std::string>& fields, std::string_view name) const {
    const Column& column = columns_.at(std::string(name));
    const auto read = name == "mass" ? mass_number_in : number_in;
    return column.unit->times(read(text_, line, fields[column.field], fmt::format("column '{}'", name)));
  }

  using State = std::pair<Vec3<double>, Vec3<double>>;

  State state(std::size_t line, const std::vector<std::string>& fields) const {
    std::array<double, 6> s{};
    for (std::size_t k = 0; k < s.size(); ++k) s[k] = number(line, fields, cartesian[k]);
    return {Vec3<double>(s[0], s[1], s[2]), Vec3<double>(s[3], s[4], s[5])};
  }

  State state_by_elements(std::size_t line, const std::vector<std::string>& fields, const std::string& name,
                          double mass, bool first) {
    if (first) {
      for (const std::string_view column : elements) {
        const std::string& word = fields[columns_.at(std::string(column)).field];
        if (word.empty() || number(line, fields, column) == 0) continue;
        text_.fail(line,
                   fmt::format("column '{}' of the first body is '{}'; the elements are about this body: leave them "
                               "empty",
                               column, word),
                   word);
      }
      if (!(mass > 0)) text_.fail(line, fmt::format("{} has no mass; the elements are about this body", name));
      primary_mass_ = mass;
      return {Vec3<double>::Zero(), Vec3<double>::Zero()};
    }
    std::array<double, 6> s{};
    for (std::size_t k = 0; k < s.size(); ++k) s[k] = number(line, fields, elements[k]);
    const bool ellipse = s[0] > 0 && s[1] >= 0 && s[1] < 1, hyperbola = s[0] < 0 && s[1] > 1;
    if (!ellipse && !hyperbola) {
      text_.fail(line, fmt::format("a = {} and e = {} are no orbit; expected a > 0 and 0 <= e < 1, or a < 0 and e > 1",
                                   fields[columns_.at("a").field], fields[columns_.at("e").field]));
    }
    return state_from_elements(OrbitalElements<double>{s[0], s[1], s[2], s[3], s[4], s[5]},
                               G_ * (primary_mass_ + mass));
  }

  const TextFile& text_;
  const UnitSystem& units_;
  double G_;
  BodyList bodies_;
  std::size_t heading_line_ = 0, field_count_ = 0;
  std::map<std::string, Column> columns_;
  bool by_elements_ = false;
  double primary_mass_ = 0;
  std::vector<std::int64_t> ids_;
  std::set<std::int64_t> known_ids_;
};

}  // namespace

ParticleSystem<double> read_csv_bodies(const TextFile& text, const UnitSystem& units, double G) {
  return CsvBodies(text, units, G).read();
}

}  // namespace noether::io

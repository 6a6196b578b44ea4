// Bodies from CSV: columns by name, units in brackets, positions and velocities or elements.
#include "engine/given_orbit.hpp"
#include "io/body_readers.hpp"
#include "io/csv_columns.hpp"
#include "numbers/quantity.hpp"
#include "numbers/suggest.hpp"
#include "numbers/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

namespace noether::io {

namespace {

constexpr std::array<std::string_view, 6> cartesian = {"x", "y", "z", "vx", "vy", "vz"};

/// What separates the fields of a table: ',' ';' tab, or ' ' for any number of blanks.
enum class Separator : char { comma = ',', semicolon = ';', tab = '\t', blank = ' ' };

std::string_view name_of(Separator separator) {
  switch (separator) {
    case Separator::comma:
      return "a comma";
    case Separator::semicolon:
      return "a semicolon";
    case Separator::tab:
      return "a tab";
    default:
      return "a blank";
  }
}

/// That of a line of column names: the first of comma, semicolon, tab and blank that stands in it outside of quotes.
Separator separator_of(std::string_view line) {
  std::string plain;
  bool quoted = false;
  for (const char c : trimmed(line.substr(0, line.find('#')))) {
    if (c == '"') quoted = !quoted;
    if (!quoted) plain += c;
  }
  for (const Separator separator : {Separator::comma, Separator::semicolon, Separator::tab}) {
    if (plain.find(static_cast<char>(separator)) != std::string::npos) return separator;
  }
  return Separator::blank;
}

/// Column names separated by blanks, without those before and within the brackets of units: "[kg m/s]" becomes
/// "[kg*m/s]".
std::string with_whole_units(std::string_view line) {
  const auto is_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  std::string result;
  bool inside = false, blank = false;
  for (const char c : line) {
    if (c == '[' || c == '(') {
      result.resize(result.find_last_not_of(" \t") + 1);
      inside = true;
    }
    if (c == ']' || c == ')') inside = false;
    if (inside && (c == ' ' || c == '\t')) {
      blank = true;
      continue;
    }
    if (blank && is_word(result.back()) && is_word(c)) result += '*';
    blank = false;
    result += c;
  }
  return result;
}

/// A line without its comment, cut at separators; separators and '#' in double quotes do not count.
std::vector<std::string> fields_of(const TextFile& text, std::size_t line, std::string_view content,
                                   Separator separator) {
  std::vector<std::string> fields(1);
  bool quoted = false, was_quoted = false, ended = false;
  const bool runs = separator == Separator::blank;
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
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
      continue;
    }
    if (c == '#') break;
    if (runs && is_blank(c)) {
      ended = !fields.back().empty() || was_quoted;
      continue;
    }
    if (ended || (!runs && c == static_cast<char>(separator))) {
      end_field();
      fields.emplace_back();
      ended = false;
      if (!runs) continue;
    }
    if (c == '"') {
      if (was_quoted || !trimmed(fields.back()).empty()) {
        text.fail(line, "a double quote is inside a field; quote the whole field, and write \"\" for a quote in it");
      }
      fields.back().clear();
      quoted = was_quoted = true;
    } else if (!was_quoted) {
      fields.back() += c;
    } else if (!is_blank(c)) {
      text.fail(line,
                fmt::format("'{}' follows the double quote that ends a field; expected {}", c, name_of(separator)));
    }
  }
  if (quoted) text.fail(line, "a double quote is not closed on this line");
  const bool empty = fields.size() == 1 && trimmed(fields[0]).empty() && !was_quoted;
  end_field();
  if (empty) return {};
  return fields;
}

/// A CSV table of bodies, read line by line.
class CsvBodies {
 public:
  CsvBodies(const TextFile& text, const BodiesOptions& options)
      : text_(text),
        units_(*options.units),
        G_(options.G.value_or(options.units->G)),
        elements_about_(options.elements),
        epoch_(options.epoch),
        options_(options),
        known_columns_(known_columns(options)),
        bodies_(text, units_) {}

  BodyTable read() {
    for (std::size_t line = 1; line <= text_.lines().size(); ++line) {
      const std::string_view content = text_.lines()[line - 1];
      if (heading_line_ == 0) {
        read_head(line, content);
      } else if (const auto fields = fields_of(text_, line, content, separator_); !fields.empty()) {
        read_row(line, fields);
      }
    }
    if (heading_line_ == 0) {
      text_.fail(0, "the table is empty; expected a line of column names, such as 'name,mass [Msun],x [au],...'");
    }
    if (bodies_.particles().size() == 0) text_.fail(heading_line_, "the table has column names, but no bodies");
    ParticleSystem<double> particles = bodies_.take();
    if (!ids_.empty()) particles.restore_ids(ids_);
    for (const auto& [info, rows] : of_parts_) {
      particles.add_column(info);
      for (std::size_t i = 0; i < rows.size(); ++i) particles.set_row(info.name, static_cast<Index>(i), rows[i]);
    }
    BodyTable table{
        .particles = std::move(particles), .left_out = std::move(left_out_), .light_center = std::move(light_center_)};
    if (epoch_) table.epoch = BodyEpoch{.julian_day = *epoch_, .scale = ""};
    return table;
  }

 private:
  struct Column {
    std::size_t field = 0;
    std::optional<Unit> unit = {};
    bool julian = false;   ///< Julian days
    bool in_days = false;  ///< times from the start in days
  };

  /// A line before the rows: column names, a comment, or "sep=;" as spreadsheets write it.
  void read_head(std::size_t line, std::string_view content) {
    if (content.starts_with("sep=") && content.size() == 5) return;
    separator_ = separator_of(content);
    const std::string whole = with_whole_units(content);
    const auto fields = fields_of(text_, line, separator_ == Separator::blank ? whole : content, separator_);
    // Spreadsheets write rows that are empty above the names too.
    const bool empty = std::all_of(fields.begin(), fields.end(), [](const std::string& one) { return one.empty(); });
    if (!empty) read_headings(line, fields);
  }

  void read_headings(std::size_t line, const std::vector<std::string>& fields) {
    heading_line_ = line;
    // Spreadsheets write columns that are empty at the end.
    const auto last = std::find_if(fields.rbegin(), fields.rend(), [](const std::string& one) { return !one.empty(); });
    field_count_ = static_cast<std::size_t>(fields.rend() - last);
    std::vector<std::pair<const KnownColumn*, Heading>> headings;
    for (std::size_t k = 0; k < field_count_; ++k) {
      const Heading heading = heading_of(fields[k], known_columns_);
      const KnownColumn& known = known_column(line, k, heading.name);
      const bool is_new = columns_.try_emplace(heading.name, Column{k}).second;
      if (!is_new) text_.fail(line, fmt::format("column '{}' appears twice", heading.name), heading.name);
      if (known.dimension.empty() && heading.unit) {
        text_.fail(line, fmt::format("column '{}' has no unit; take '{}' out", heading.name, *heading.unit),
                   *heading.unit);
      }
      headings.emplace_back(&known, heading);
    }
    for (const auto& [known, heading] : headings) {
      if (known->dimension.empty()) continue;
      std::set<std::string> beside;  // units of the columns of its group
      for (const auto& [other, its] : headings) {
        const bool same = other->group == known->group && !known->group.empty();
        const bool plain = units_.is_reduced() && (its.unit == "1" || its.unit == "rad");
        if (same && its.unit && !plain) beside.insert(*its.unit);
      }
      Column& column = columns_.at(heading.name);
      column.julian = heading.name == "T" && heading.unit == "JD";
      column.unit = column.julian ? unit_of_days(line) : unit_of_column(line, heading, known->dimension, beside);
      column.in_days = heading.name == "T" && !column.julian && !units_.is_reduced() &&
                       column.unit->times(1) == unit_value("day", units_);
    }
    check_columns(line);
    find_columns_of_parts(line);
  }

  /// Which columns of parts the table has: all numbers of each, or none.
  void find_columns_of_parts(std::size_t line) {
    for (const auto* list : {&options_.columns, &options_.left_out}) {
      for (const ColumnInfo& info : *list) {
        const std::vector<std::string> names = names_of(info);
        std::vector<std::string> missing;
        for (const std::string& name : names) {
          if (!has(name)) missing.push_back(name);
        }
        if (missing.size() == names.size()) continue;
        if (!missing.empty()) {
          text_.fail(line, fmt::format("there is no column {}; expected all of {}", fmt::join(missing, ", "),
                                       fmt::join(names, ", ")));
        }
        if (list == &options_.columns) of_parts_.emplace_back(info, std::vector<std::vector<double>>());
        if (list == &options_.left_out) left_out_.push_back(info.name);
      }
    }
  }

  const KnownColumn& known_column(std::size_t line, std::size_t field, const std::string& name) const {
    std::vector<std::string> names;
    for (const KnownColumn& known : known_columns_) {
      if (known.name == name) return known;
      names.push_back(known.name);
    }
    if (name.empty()) {
      text_.fail(line, fmt::format(
                           "column {} has no name{}", field + 1,
                           field == 0 ? "; if it is the row numbers of pandas, write the table with index=False" : ""));
    }
    double number = 0;
    const auto [end, problem] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (problem == std::errc() && end == name.data() + name.size()) {
      text_.fail(line,
                 fmt::format("'{}' is a number where a column name is expected; the first line names the columns, such "
                             "as 'name,mass [Msun],x [au],...', and must not be a comment",
                             name),
                 name);
    }
    refuse_names_in_comment(line);
    for (const auto* list : {&options_.columns, &options_.left_out}) {
      for (const ColumnInfo& info : *list) {
        if (info.name != name) continue;
        text_.fail(line,
                   fmt::format("column '{}' has {} numbers; give a column for each: {}", name, info.width,
                               fmt::join(names_of(info), ", ")),
                   name);
      }
    }
    const OtherName other = other_name_of(name);
    text_.fail(line,
               fmt::format("unknown column '{}'{}", name,
                           other.told.empty() ? did_you_mean(name, names) : std::string(other.told)),
               name);
  }

  /// Refuses column names that stand behind '#', as some programs write them: the first row would pass for names.
  void refuse_names_in_comment(std::size_t line) const {
    for (std::size_t above = 1; above < line; ++above) {
      std::string content = text_.lines()[above - 1];
      if (!trimmed(content).starts_with('#')) continue;
      std::replace_if(
          content.begin(), content.end(), [](char c) { return c == '#' || c == ',' || c == ';'; }, ' ');
      int known = 0;
      for (const std::string& word : words_of(content)) {
        for (const KnownColumn& column : known_columns_) known += column.name == word ? 1 : 0;
      }
      if (known < 3) continue;
      text_.fail(above, "the column names are in a comment; take out the '#' before them");
    }
  }

  /// The unit of a column: its own, or that of its group.
  Unit unit_of_column(std::size_t line, const Heading& heading, std::string_view words,
                      const std::set<std::string>& beside) const {
    const Dimension expected = parse_dimension(words);
    const bool reduced = units_.is_reduced(), bare = !heading.unit || (reduced && *heading.unit == "1");
    if (bare && (words == "1" || (reduced && (beside.empty() || heading.unit)))) return parse_unit("1", units_);
    if (bare && (beside.size() != 1 || reduced)) {
      const std::string example = !beside.empty()    ? *beside.begin()
                                  : words == "angle" ? "deg"
                                                     : noether::unit_of(expected, units_);
      const std::string why = beside.empty() ? "" : fmt::format(" beside '{}'", fmt::join(beside, "' and '"));
      text_.fail(line,
                 fmt::format("column '{0}' has no unit{1}; write '{0} [{2}]' or another unit of {3}", heading.name, why,
                             example, words),
                 heading.name);
    }
    return read_unit(line, heading.name, bare ? *beside.begin() : *heading.unit, expected, words);
  }

  /// The unit of a column of Julian days beside the epoch.
  Unit unit_of_days(std::size_t line) const {
    if (units_.is_reduced()) text_.fail(line, "column 'T' is in Julian days; the reduced system has none", "JD");
    if (!epoch_) {
      text_.fail(line,
                 "column 'T' is in Julian days, but the epoch of the start is not given; give epoch = \"JD ...\" in "
                 "[particles]",
                 "JD");
    }
    return parse_unit("day", units_);
  }

  Unit read_unit(std::size_t line, const std::string& column, const std::string& text, const Dimension& expected,
                 std::string_view words) const {
    Unit unit;
    try {
      unit = parse_unit(text, words, units_);
    } catch (const Error& error) {
      text_.fail(line, fmt::format("column '{}': {}", column, error.message()), text);
    }
    if (unit.dimension == expected) return unit;
    const bool meant = column == "M" && unit.dimension == dimensions::mass;  // the mean anomaly
    text_.fail(line,
               fmt::format("column '{}' is in '{}', which has the dimension {}; expected {}{}", column, text,
                           to_text(unit.dimension), words, meant ? "; did you mean 'mass'?" : ""),
               text);
  }

  bool has(std::string_view name) const { return columns_.count(std::string(name)) != 0; }

  void check_columns(std::size_t line) {
    const auto present = [&](std::string_view name) { return has(name); };
    const auto x = std::find_if(cartesian.begin(), cartesian.end(), present);
    const auto a = std::find_if(orbit_keys.begin(), orbit_keys.end(), [&](const auto& key) { return has(key.name); });
    if (x != cartesian.end() && a != orbit_keys.end()) {
      text_.fail(
          line,
          fmt::format("columns '{}' and '{}' do not go together; give either positions and velocities, or elements", *x,
                      a->name));
    }
    by_elements_ = a != orbit_keys.end();
    std::vector<std::string> missing;
    if (!has("mass")) missing.emplace_back("mass");
    if (by_elements_) {
      std::map<OrbitKey::Choice, std::vector<std::string>> choices;
      std::set<OrbitKey::Choice> made;
      for (const OrbitKey& key : orbit_keys) {
        choices[key.choice].emplace_back(key.name);
        if (has(key.name)) made.insert(key.choice);
      }
      for (const auto& [choice, names] : choices) {
        if (made.count(choice) == 0) missing.push_back(names.front());
      }
    } else {
      for (const std::string_view name : cartesian) {
        if (!has(name)) missing.emplace_back(name);
      }
    }
    if (missing.empty()) return;
    text_.fail(line, fmt::format("there is no column {}; expected mass and {}", fmt::join(missing, ", "),
                                 by_elements_ ? "a (or P, q), e, inc, Omega, omega (or pomega), M (or f, l, T)"
                                              : "x, y, z, vx, vy, vz, or the elements a, e, inc, Omega, omega, M"));
  }

  /// A row; one of empty fields, as spreadsheets write below a table, is none.
  void read_row(std::size_t line, const std::vector<std::string>& fields) {
    const auto is_empty = [](const std::string& one) { return one.empty(); };
    const std::size_t named = std::min(field_count_, fields.size());
    const bool nothing_more = std::all_of(fields.begin() + static_cast<std::ptrdiff_t>(named), fields.end(), is_empty);
    if (fields.size() > 1 && nothing_more && std::all_of(fields.begin(), fields.end(), is_empty)) return;
    if (fields.size() < field_count_ || !nothing_more) {
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
    const auto [x, v] = state(line, fields, name, mass);
    bodies_.add(line, name, mass, x, v);
    for (auto& [info, rows] : of_parts_) {
      std::vector<double>& numbers = rows.emplace_back();
      for (const std::string& part : names_of(info)) {
        numbers.push_back(number(line, fields, part));
        if (std::isfinite(numbers.back())) continue;
        text_.fail(line, fmt::format("the {} of {} is not finite in these units", info.name, name));
      }
    }
    if (has("about")) index_.emplace(name, row);
    if (by_elements_) before_.add(mass, x, v);
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
    if (!known_ids_.insert(id).second)
      text_.fail(line, fmt::format("the id {} is already used; ids must differ", id), word);
    ids_.push_back(id);
  }

  double number(std::size_t line, const std::vector<std::string>& fields, std::string_view name) const {
    const Column& column = columns_.at(std::string(name));
    const auto read = name == "mass" ? mass_number_in : number_in;
    const std::string& word = fields[column.field];
    const double value = read(text_, line, word, fmt::format("column '{}'", name));
    if (column.julian && is_modified_beside(value - *epoch_)) {
      text_.fail(
          line,
          fmt::format("column '{}' is JD {}, {:.9g} days from the epoch, JD {}: one of them looks like a modified "
                      "Julian day; add 2400000.5 to it",
                      name, word, std::abs(value - *epoch_), format_number(*epoch_)),
          word);
    }
    if (column.julian) return column.unit->times(value - *epoch_);
    if (column.in_days && looks_like_julian_day(value)) {
      text_.fail(
          line,
          fmt::format("column '{}' is {}, counted from the start, which looks like a Julian day; name the column 'T "
                      "[JD]' and give the epoch in [particles], or give the time in yr if it is a time",
                      name, word),
          word);
    }
    return column.unit->times(value);
  }

  using State = std::pair<Vec3<double>, Vec3<double>>;

  State state(std::size_t line, const std::vector<std::string>& fields, const std::string& name, double mass) {
    const std::vector<Index> about = bodies_about(line, fields);
    if (!by_elements_) {
      const State state = cartesian_state(line, fields);
      return about.empty() ? state : moved(state, center_at(line, about));
    }
    if (bodies_.particles().size() == 0) return first_state(line, fields, name, mass);
    const bool jacobi = about.empty() && elements_about_ == ElementsAbout::all_before_it;
    if (about.empty() && !jacobi && light_center_.empty())
      light_center_ = about_a_light_body(bodies_.particles(), bodies_.particles().size(), name);
    const OrbitCenter center = jacobi ? before_ : center_at(line, about.empty() ? std::vector<Index>{0} : about);
    if (center.mass() + mass == 0) {
      const std::string& word = fields[columns_.at("about").field];
      text_.fail(line, fmt::format("column 'about' is '{}', which has no mass, so nothing can orbit it", word), word);
    }
    const State state = state_by_elements(line, fields, G_ * (center.mass() + mass));
    // The first body rests in the origin.
    return about.empty() && !jacobi ? state : moved(state, center);
  }

  State cartesian_state(std::size_t line, const std::vector<std::string>& fields) const {
    std::array<double, 6> s{};
    for (std::size_t k = 0; k < s.size(); ++k) s[k] = number(line, fields, cartesian[k]);
    return {Vec3<double>(s[0], s[1], s[2]), Vec3<double>(s[3], s[4], s[5])};
  }

  static State moved(const State& state, const OrbitCenter& center) {
    return {state.first + center.x(), state.second + center.v()};
  }

  /// The bodies above that `about` names: one, or several with '+' between them; none where it is empty.
  std::vector<Index> bodies_about(std::size_t line, const std::vector<std::string>& fields) const {
    if (!has("about")) return {};
    const std::string& word = fields[columns_.at("about").field];
    if (word.empty()) return {};
    std::vector<Index> found;
    std::string_view rest = word;
    while (index_.count(word) == 0) {
      const std::size_t end = rest.find('+');
      found.push_back(body_named(line, std::string(trimmed(rest.substr(0, end)))));
      if (end == std::string_view::npos) return found;
      rest.remove_prefix(end + 1);
    }
    return {index_.at(word)};
  }

  Index body_named(std::size_t line, const std::string& name) const {
    const auto found = index_.find(name);
    if (found != index_.end()) return found->second;
    const std::vector<std::string>& names = bodies_.particles().names();
    if (names.empty())
      text_.fail(line, "column 'about' of the first body must be empty, because no body is above it", name);
    text_.fail(line, fmt::format("there is no body '{}' above this one{}", name, did_you_mean(name, names)), name);
  }

  OrbitCenter center_at(std::size_t line, const std::vector<Index>& about) const {
    try {
      return center_of(bodies_.particles(), about);
    } catch (const Error& error) {
      text_.fail(line, error.message());
    }
  }

  /// The first body of a table of elements: at rest in the origin.
  State first_state(std::size_t line, const std::vector<std::string>& fields, const std::string& name, double mass) {
    for (const OrbitKey& key : orbit_keys) {
      if (!has(key.name)) continue;
      const std::string& word = fields[columns_.at(std::string(key.name)).field];
      if (word.empty() || number(line, fields, key.name) == 0) continue;
      text_.fail(
          line,
          fmt::format("column '{}' of the first body is '{}', but elements are relative to this body; leave them empty",
                      key.name, word),
          word);
    }
    if (!(mass > 0))
      text_.fail(line, fmt::format("{} has no mass, but elements are relative to this body; give it a mass", name));
    return {Vec3<double>::Zero(), Vec3<double>::Zero()};
  }

  State state_by_elements(std::size_t line, const std::vector<std::string>& fields, double mu) const {
    GivenOrbit orbit;
    for (const OrbitKey& key : orbit_keys) {
      if (!has(key.name)) continue;
      // A field may be empty where another column of its choice stands beside it.
      const bool alone = std::none_of(orbit_keys.begin(), orbit_keys.end(), [&](const OrbitKey& other) {
        return other.choice == key.choice && other.name != key.name && has(other.name);
      });
      const bool empty = fields[columns_.at(std::string(key.name)).field].empty();
      if (alone || !empty) orbit.*key.value = number(line, fields, key.name);
    }
    const double e = orbit.e.value_or(0);
    if (orbit.a && !orbit.P && !orbit.q && !(*orbit.a > 0 && e >= 0 && e < 1) && !(*orbit.a < 0 && e > 1)) {
      text_.fail(
          line,
          fmt::format("a = {} and e = {} do not describe an orbit; expected a > 0 and 0 <= e < 1, or a < 0 and e > 1",
                      fields[columns_.at("a").field], fields[columns_.at("e").field]));
    }
    try {
      return state_of_orbit(orbit, mu);
    } catch (const Error& error) {
      refuse(line, fields, error);
    }
  }

  /// Ends reading with what is wrong with an element, which is shown as it was written.
  [[noreturn]] void refuse(std::size_t line, const std::vector<std::string>& fields, const Error& error) const {
    std::string message = error.message();
    const std::string start = error.key() + " = " + error.value();
    const auto column = columns_.find(error.key());
    if (column != columns_.end() && message.starts_with(start)) {
      message.replace(0, start.size(), error.key() + " = " + fields[column->second.field]);
    }
    text_.fail(line, message);
  }

  const TextFile& text_;
  const UnitSystem& units_;
  double G_;
  ElementsAbout elements_about_;
  std::string light_center_;  ///< what `BodyTable` tells
  std::optional<double> epoch_;
  const BodiesOptions& options_;
  std::vector<KnownColumn> known_columns_;
  BodyList bodies_;
  Separator separator_ = Separator::comma;
  std::size_t heading_line_ = 0, field_count_ = 0;
  std::map<std::string, Column> columns_;
  bool by_elements_ = false;
  /// Columns of parts that the table has, and their rows.
  std::vector<std::pair<ColumnInfo, std::vector<std::vector<double>>>> of_parts_;
  std::vector<std::string> left_out_;
  OrbitCenter before_;                            ///< of all bodies above
  std::unordered_map<std::string, Index> index_;  ///< by name, where `about` asks for it
  std::vector<std::int64_t> ids_;
  std::set<std::int64_t> known_ids_;
};

}  // namespace

BodyTable read_csv_bodies(const TextFile& text, const BodiesOptions& options) {
  return CsvBodies(text, options).read();
}

}  // namespace noether::io

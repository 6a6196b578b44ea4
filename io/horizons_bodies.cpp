// Bodies from vector tables as JPL Horizons prints them: text or CSV, with or without labels, one or more in a file.
#include "io/text_table.hpp"
#include "numbers/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <map>
#include <utility>

namespace noether::io {

namespace {

/// GM of a body, or of a planet with its moons (numbers 1 to 9) [km^3/s^2].
struct KnownMass {
  int number;
  double GM;
};

/// The outer planets without their moons are the solutions for satellites that JPL lists beside DE440.
/// @source Park2021
constexpr std::array known_masses = {
    KnownMass{10, 132712440041.27942}, KnownMass{1, 22031.868551},
    KnownMass{2, 324858.592},          KnownMass{3, 403503.235625},
    KnownMass{4, 42828.375816},        KnownMass{5, 126712764.1},
    KnownMass{6, 37940584.8418},       KnownMass{7, 5794556.4},
    KnownMass{8, 6836527.10058},       KnownMass{9, 975.5},
    KnownMass{199, 22031.868551},      KnownMass{299, 324858.592},
    KnownMass{399, 398600.435507},     KnownMass{301, 4902.800118},
    KnownMass{499, 42828.37362069909}, KnownMass{599, 126686531.9003704},
    KnownMass{699, 37931206.23436167}, KnownMass{799, 5793951.256527211},
    KnownMass{899, 6835103.145462294}, KnownMass{999, 869.6138177608748},
};

constexpr std::string_view table_start = "$$SOE", table_end = "$$EOE";
constexpr std::array<std::string_view, 6> components = {"X", "Y", "Z", "VX", "VY", "VZ"};

/// What stands between "label :" and a remark in braces, if the line begins with the label.
std::optional<std::string> value_after(std::string_view line, std::string_view label) {
  line = trimmed(line);
  if (!line.starts_with(label)) return {};
  line = trimmed(line.substr(label.size()));
  if (!line.starts_with(':')) return {};
  return std::string(trimmed(line.substr(1, line.find('{') - 1)));
}

/// One table: what its head says, and where its records stand (lines counted from 1).
struct Table {
  std::string target, center, frame, units;
  std::optional<int> number;  ///< of the body, in parentheses after its name
  std::optional<double> mass;
  std::vector<std::string> headings;  ///< of a table with commas
  std::size_t target_line = 0, start = 0, end = 0;
};

/// A record: its epoch and six numbers by name.
struct Record {
  std::size_t line = 0;
  double epoch = 0;  ///< Julian day
  std::map<std::string, double> values;
  std::optional<double> mass;
};

class HorizonsBodies {
 public:
  HorizonsBodies(const TextFile& text, const UnitSystem& units, double G)
      : text_(text), units_(units), G_(G), bodies_(text, units) {}

  ParticleSystem<double> read() {
    if (units_.is_reduced()) {
      text_.fail(0, "a Horizons table has units; expected the unit system solar, si or molecular, not reduced");
    }
    std::size_t line = 1;
    while (const std::optional<Table> table = next_table(line)) {
      add(*table);
      line = table->end + 1;
    }
    return bodies_.take();
  }

 private:
  const std::string& at(std::size_t line) const { return text_.lines()[line - 1]; }

  /// The next table at or after a line.
  std::optional<Table> next_table(std::size_t line) const {
    Table table;
    std::string_view last_text;
    for (; line <= text_.lines().size(); ++line) {
      const std::string_view content = trimmed(at(line));
      if (content == table_start) break;
      read_head(table, line);
      if (!content.empty() && content.front() != '*') last_text = content;
    }
    if (line > text_.lines().size()) return {};
    table.start = line;
    for (; line <= text_.lines().size() && trimmed(at(line)) != table_end; ++line) {
    }
    if (line > text_.lines().size())
      text_.fail(table.start, "the table that begins here has no end: '$$EOE' is missing");
    table.end = line;
    if (last_text.find(',') != std::string_view::npos) table.headings = split_at_commas(last_text);
    return table;
  }

  void read_head(Table& table, std::size_t line) const {
    const std::string& content = at(line);
    if (const auto target = value_after(content, "Target body name")) {
      table.target_line = line;
      read_target(table, *target);
    }
    if (const auto center = value_after(content, "Center body name")) table.center = *center;
    if (const auto frame = value_after(content, "Reference frame")) table.frame = *frame;
    if (const auto units = value_after(content, "Output units")) table.units = units->substr(0, units->find(','));
    const auto type = value_after(content, "Output type");
    if (type && type->find("elements") != std::string::npos) {
      text_.fail(line, "this is a table of elements; ask Horizons for vectors (EPHEM_TYPE = VECTORS)");
    }
    if (const auto mass = mass_of_line(line)) table.mass = mass;
  }

  /// "Jupiter Barycenter (5)": the number in the last parentheses, if it is one.
  static void read_target(Table& table, const std::string& target) {
    const std::size_t open = target.rfind('('), close = target.rfind(')');
    table.target = target;
    if (open == std::string::npos || close == std::string::npos || close < open) return;
    int number = 0;
    const char* first = target.data() + open + 1;
    const auto [end, problem] = std::from_chars(first, target.data() + close, number);
    if (problem != std::errc() || end != target.data() + close) return;
    table.number = number;
    table.target = trimmed(target.substr(0, open));
  }

  /// A line "mass [kg] = 1.9e27" that a user has put in.
  std::optional<double> mass_of_line(std::size_t line) const {
    const std::string_view content = trimmed(at(line));
    const std::size_t equals = content.find_first_of("=:");
    if (!content.starts_with("mass") || equals == std::string_view::npos) return {};
    const Heading heading = parse_heading(trimmed(content.substr(0, equals)));
    if (heading.name != "mass" || !heading.unit) return {};
    return mass_in(line, heading, trimmed(content.substr(equals + 1)));
  }

  double mass_in(std::size_t line, const Heading& heading, std::string_view word) const {
    try {
      const Unit unit = parse_unit(heading.unit.value_or("1"), units_);
      if (unit.dimension == dimensions::mass) return unit.times(mass_number_in(text_, line, word, "the mass"));
    } catch (const SceneError&) {
      throw;
    } catch (const Error& error) {
      text_.fail(line, "mass: " + error.message());
    }
    text_.fail(line, fmt::format("the mass is in '{}'; expected a unit of mass, such as 'mass [kg]'",
                                 heading.unit.value_or("1")));
  }

  void add(const Table& table) {
    if (table.target_line == 0) text_.fail(table.start, "the head of this table has no line 'Target body name'");
    check_agreement(table);
    const Record record = table.headings.empty() ? text_record(table) : comma_record(table);
    for (const std::string_view name : components) {
      if (record.values.count(std::string(name)) != 0) continue;
      text_.fail(record.line,
                 fmt::format("the table of {} has no {}; ask Horizons for positions and velocities (vector "
                             "table type 2 or 3)",
                             table.target, name));
    }
    if (!epoch_) epoch_ = record.epoch;
    if (record.epoch != *epoch_) {
      text_.fail(
          record.line,
          fmt::format("the table of {} begins at JD {}, that of {} at JD {}; take one epoch for all", table.target,
                      format_number(record.epoch), bodies_.particles().name(0), format_number(*epoch_)));
    }
    const auto [length, velocity] = units_of(table);
    const auto vector = [&](std::size_t first, const Unit& unit) {
      const auto value = [&](std::size_t k) {
        return unit.times(record.values.at(std::string(components[first + k])));
      };
      return Vec3<double>(value(0), value(1), value(2));
    };
    const double mass = record.mass ? *record.mass : mass_of(table);
    bodies_.add(table.target_line, table.target, mass, vector(0, length), vector(3, velocity));
  }

  /// All tables must be about one center and in one frame.
  void check_agreement(const Table& table) {
    if (!first_) first_ = table;
    if (table.center != first_->center) {
      text_.fail(table.target_line,
                 fmt::format("the table of {} is about '{}', that of {} about '{}'; take one center for "
                             "all",
                             table.target, table.center, first_->target, first_->center));
    }
    if (table.frame != first_->frame) {
      text_.fail(table.target_line,
                 fmt::format("the table of {} is in the frame '{}', that of {} in '{}'; take one frame "
                             "for all",
                             table.target, table.frame, first_->target, first_->frame));
    }
  }

  std::pair<Unit, Unit> units_of(const Table& table) const {
    static constexpr std::array<std::array<std::string_view, 3>, 3> known = {
        {{"AU-D", "au", "au/day"}, {"KM-S", "km", "km/s"}, {"KM-D", "km", "km/day"}}};
    for (const auto& [name, length, velocity] : known) {
      if (table.units == name) return {parse_unit(length, units_), parse_unit(velocity, units_)};
    }
    text_.fail(table.target_line,
               fmt::format("the output units of {} are '{}'; expected AU-D, KM-S or KM-D", table.target, table.units),
               table.units);
  }

  double mass_of(const Table& table) const {
    if (table.mass) return *table.mass;
    const auto known = std::find_if(known_masses.begin(), known_masses.end(),
                                    [&](const KnownMass& one) { return one.number == table.number; });
    if (known != known_masses.end()) return parse_unit("km^3/s^2", units_).times(known->GM) / G_;
    text_.fail(table.target_line,
               fmt::format("the mass of {} is not built in, and Horizons gives none; put a line 'mass "
                           "[kg] = ...' (0 for a tracer) before '$$SOE'",
                           table.target));
  }

  Record comma_record(const Table& table) const {
    Record record;
    record.line = first_record(table);
    const std::vector<std::string> fields = split_at_commas(at(record.line));
    const std::size_t count = std::min(fields.size(), table.headings.size());
    record.epoch = number_in(text_, record.line, fields[0], "the Julian day");
    for (std::size_t k = 1; k < count; ++k) {
      const Heading heading = parse_heading(table.headings[k]);
      if (std::find(components.begin(), components.end(), heading.name) != components.end()) {
        record.values[heading.name] = number_in(text_, record.line, fields[k], heading.name);
      }
      if (heading.name == "mass") record.mass = mass_in(record.line, heading, fields[k]);
    }
    return record;
  }

  std::size_t first_record(const Table& table) const {
    for (std::size_t line = table.start + 1; line < table.end; ++line) {
      if (!trimmed(at(line)).empty()) return line;
    }
    text_.fail(table.start, fmt::format("the table of {} is empty", table.target));
  }

  /// "2451545.000000000 = A.D. 2000-Jan-01 12:00:00.0000 TDB", then "X = ... Y = ... Z = ..." with or without labels.
  Record text_record(const Table& table) const {
    Record record;
    record.line = first_record(table);
    const std::string& head = at(record.line);
    record.epoch =
        number_in(text_, record.line, trimmed(std::string_view(head).substr(0, head.find('='))), "the Julian day");
    std::size_t unlabeled = 0;
    for (std::size_t line = record.line + 1; line < table.end; ++line) {
      if (at(line).find("A.D.") != std::string::npos || at(line).find("B.C.") != std::string::npos) break;
      read_numbers(line, record, unlabeled);
    }
    return record;
  }

  void read_numbers(std::size_t line, Record& record, std::size_t& unlabeled) const {
    std::string label;
    for (const std::string& word : words_of(line)) {
      const bool awaited = std::find(components.begin(), components.end(), label) != components.end();
      if (std::isalpha(static_cast<unsigned char>(word.front())) != 0 && !awaited) {
        label = word;
        continue;
      }
      if (label.empty() && unlabeled < components.size()) label = components[unlabeled++];
      if (!label.empty()) record.values[label] = number_in(text_, line, word, label);
      label.clear();
    }
  }

  std::vector<std::string> words_of(std::size_t line) const {
    std::vector<std::string> words(1);
    for (const char c : at(line)) {
      if (c != ' ' && c != '\t' && c != '=') {
        words.back() += c;
      } else if (!words.back().empty()) {
        words.emplace_back();
      }
    }
    if (words.back().empty()) words.pop_back();
    return words;
  }

  const TextFile& text_;
  const UnitSystem& units_;
  double G_;
  BodyList bodies_;
  std::optional<Table> first_;
  std::optional<double> epoch_;
};

}  // namespace

bool is_horizons(const TextFile& text) {
  return std::any_of(text.lines().begin(), text.lines().end(),
                     [](const std::string& line) { return trimmed(line) == table_start; });
}

ParticleSystem<double> read_horizons_bodies(const TextFile& text, const UnitSystem& units, double G) {
  return HorizonsBodies(text, units, G).read();
}

}  // namespace noether::io

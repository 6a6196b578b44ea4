// Bodies from vector tables as JPL Horizons prints them: text or CSV, with or without labels, one or more in a file.
#include "io/body_readers.hpp"
#include "io/horizons_table.hpp"
#include "numbers/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>

namespace noether::io {

namespace {

constexpr std::array<std::string_view, 6> components = {"X", "Y", "Z", "VX", "VY", "VZ"};
constexpr int solar_system = 0, sun = 10;

/// Whether a number is that of a planet or moon, 3 for 301 and 399, 6 for 65035: the system it belongs to; else 0.
int system_of(const HorizonsObject& object) {
  const int number = object.number.value_or(0);
  if (number > 100 && number < 1000) return number / 100;
  if (number > 10'000 && number < 100'000 && number / 1000 % 10 == 5) return number / 10'000;
  return 0;
}

/// Whether a number is that of the barycenter of a planet and its moons.
bool is_system(const HorizonsObject& object) { return object.number && *object.number > 0 && *object.number < 10; }

/// A record: its epoch and six numbers by name.
struct Record {
  std::size_t line = 0;
  double epoch = 0;  ///< Julian day
  std::map<std::string, double> values;
  std::optional<double> mass;
};

/// What becomes a particle.
struct Body {
  std::size_t line = 0;
  HorizonsObject object;
  double mass = 0;
  bool own_mass = false;  ///< given by the user
  Vec3<double> x = Vec3<double>::Zero(), v = Vec3<double>::Zero();
};

class HorizonsBodies {
 public:
  HorizonsBodies(const TextFile& text, const BodiesOptions& options)
      : text_(text),
        units_(*options.units),
        G_(options.G.value_or(options.units->G)),
        wanted_(options.epoch),
        list_(text, units_) {}

  BodyTable read() {
    if (units_.is_reduced()) {
      text_.fail(0, "a Horizons table has units; expected the unit system solar, si or molecular, not reduced");
    }
    std::size_t line = 1;
    while (const std::optional<HorizonsTable> table = next_horizons_table(text_, units_, line)) {
      add(*table);
      line = table->end + 1;
    }
    join_center();
    check_masses_once();
    for (const Body& body : bodies_) list_.add(body.line, body.object.name, body.mass, body.x, body.v);
    const bool of_solar_system = first_->center.number == solar_system;
    return {.particles = list_.take(),
            .epoch = BodyEpoch{*epoch_, first_->time_scale},
            .without_sun = of_solar_system && !has_number(sun)};
  }

 private:
  const std::string& at(std::size_t line) const { return text_.lines()[line - 1]; }

  bool has_number(int number) const {
    return std::any_of(bodies_.begin(), bodies_.end(), [&](const Body& body) { return body.object.number == number; });
  }

  void add(const HorizonsTable& table) {
    check_agreement(table);
    const Record record = record_of(table);
    for (const std::string_view name : components) {
      if (record.values.count(std::string(name)) != 0) continue;
      text_.fail(record.line,
                 fmt::format("the table of {} has no {}; ask Horizons for positions and velocities (vector "
                             "table type 2 or 3)",
                             table.target.name, name));
    }
    if (!epoch_) epoch_ = record.epoch;
    if (record.epoch != *epoch_) {
      text_.fail(
          record.line,
          fmt::format("the table of {} begins at JD {}, that of {} at JD {}; take one epoch for all", table.target.name,
                      format_number(record.epoch), first_->target.name, format_number(*epoch_)));
    }
    const auto [length, velocity] = units_of(table);
    const auto vector = [&](std::size_t first, const Unit& unit) {
      const auto value = [&](std::size_t k) {
        return unit.times(record.values.at(std::string(components[first + k])));
      };
      return Vec3<double>(value(0), value(1), value(2));
    };
    const auto own_mass = record.mass ? record.mass : table.mass;
    bodies_.push_back({.line = table.target_line,
                       .object = table.target,
                       .mass = own_mass ? *own_mass : mass_of(table),
                       .own_mass = own_mass.has_value(),
                       .x = vector(0, length),
                       .v = vector(3, velocity)});
    if (table.center_mass) center_mass_ = table.center_mass;
  }

  /// All tables must be about one center, in one frame and in one scale of time.
  void check_agreement(const HorizonsTable& table) {
    if (!first_) first_ = table;
    const std::string &name = table.target.name, &first = first_->target.name;
    if (table.center != first_->center) {
      text_.fail(table.target_line,
                 fmt::format("the table of {} is about '{}', that of {} about '{}'; take one center for "
                             "all",
                             name, table.center.text, first, first_->center.text));
    }
    if (table.frame != first_->frame) {
      text_.fail(table.target_line, fmt::format("the table of {} is in the frame '{}', that of {} in '{}'; take one "
                                                "frame for all",
                                                name, table.frame, first, first_->frame));
    }
    if (table.time_scale != first_->time_scale && !table.time_scale.empty() && !first_->time_scale.empty()) {
      text_.fail(table.target_line, fmt::format("the table of {} is in the time scale '{}', that of {} in '{}'; take "
                                                "one time scale for all",
                                                name, table.time_scale, first, first_->time_scale));
    }
  }

  /// The body that all states are about attracts the others: it stands first, at rest in the origin. A barycenter is
  /// only a place where what it is the barycenter of is among the bodies.
  void join_center() {
    const HorizonsObject& center = first_->center;
    if (center.text.empty() || center.number == solar_system) return;
    for (const Body& body : bodies_) {
      if (body.object != center) continue;
      if (body.x == Vec3<double>::Zero() && body.v == Vec3<double>::Zero()) return;
      text_.fail(body.line,
                 fmt::format("{} is not at rest at the origin, but all states are relative to it; take this table out",
                             center.text));
    }
    const auto is_member = [&](const Body& body) { return system_of(body.object) == center.number; };
    const auto member = std::find_if(bodies_.begin(), bodies_.end(), is_member);
    if (is_system(center) && member != bodies_.end()) {
      const int planet = *center.number * 100 + 99;
      if (has_number(planet)) return;
      text_.fail(member->line,
                 fmt::format("the states are about '{}', but its planet ({}) is not among the bodies; add "
                             "its table",
                             center.text, planet));
    }
    Body body{.line = first_->target_line, .object = center, .own_mass = center_mass_.has_value()};
    const auto mass = center_mass_ ? center_mass_ : known_mass(center);
    if (!mass) {
      text_.fail(first_->target_line,
                 fmt::format("the states are about '{}', whose mass is not known; put a line 'center mass [kg] = "
                             "...' before '$$SOE', or ask Horizons for states about the Solar System Barycenter "
                             "(CENTER = '500@0')",
                             center.text));
    }
    body.mass = *mass;
    bodies_.insert(bodies_.begin(), std::move(body));
  }

  /// GM of a barycenter is that of all its bodies. @throws SceneError where one of these stands beside it
  void check_masses_once() const {
    for (const Body& whole : bodies_) {
      if (!is_system(whole.object) || whole.own_mass || whole.mass == 0) continue;
      for (const Body& part : bodies_) {
        if (system_of(part.object) != whole.object.number || part.mass == 0) continue;
        text_.fail(
            part.line,
            fmt::format("the mass of {} ({}) would count twice, because {} ({}) includes it; take one of them out",
                        part.object.name, *part.object.number, whole.object.name, *whole.object.number));
      }
    }
  }

  std::pair<Unit, Unit> units_of(const HorizonsTable& table) const {
    static constexpr std::array<std::array<std::string_view, 3>, 3> known = {
        {{"AU-D", "au", "au/day"}, {"KM-S", "km", "km/s"}, {"KM-D", "km", "km/day"}}};
    for (const auto& [name, length, velocity] : known) {
      if (table.units == name) return {parse_unit(length, units_), parse_unit(velocity, units_)};
    }
    text_.fail(
        table.target_line,
        fmt::format("the output units of {} are '{}'; expected AU-D, KM-S or KM-D", table.target.name, table.units),
        table.units);
  }

  std::optional<double> known_mass(const HorizonsObject& object) const {
    const std::optional<double> GM = known_GM(object);
    if (!GM) return {};
    return parse_unit("km^3/s^2", units_).times(*GM) / G_;
  }

  double mass_of(const HorizonsTable& table) const {
    if (const auto mass = known_mass(table.target)) return *mass;
    if (table.target.number == solar_system) {
      text_.fail(table.target_line, fmt::format("{} is a place, not a body; take its table out", table.target.name));
    }
    text_.fail(table.target_line,
               fmt::format("the mass of {} is not known, and Horizons does not give it; put a line 'mass "
                           "[kg] = ...' (0 for a tracer) before '$$SOE'",
                           table.target.name));
  }

  // ---- records -----------------------------------------------------------------------------------------------------

  static bool has_date(const std::string& line) {
    return line.find("A.D.") != std::string::npos || line.find("B.C.") != std::string::npos;
  }

  /// The lines where records begin.
  std::vector<std::size_t> record_lines(const HorizonsTable& table) const {
    std::vector<std::size_t> lines;
    for (std::size_t line = table.start + 1; line < table.end; ++line) {
      if (trimmed(at(line)).empty()) continue;
      if (lines.empty() || !table.headings.empty() || has_date(at(line))) lines.push_back(line);
    }
    if (lines.empty()) text_.fail(table.start, fmt::format("the table of {} is empty", table.target.name));
    return lines;
  }

  double epoch_at(const HorizonsTable& table, std::size_t line) const {
    const std::string_view content = at(line);
    const char mark = table.headings.empty() ? '=' : table.separator;
    return number_in(text_, line, trimmed(content.substr(0, content.find(mark))), "the Julian day");
  }

  /// The first record, or that of the epoch that is asked for.
  Record record_of(const HorizonsTable& table) const {
    static constexpr double printed = 1e-9;  // days: the last digit of a Julian day
    const std::vector<std::size_t> lines = record_lines(table);
    const auto is_wanted = [&](std::size_t line) {
      return !wanted_ || std::abs(epoch_at(table, line) - *wanted_) <= printed;
    };
    const auto found = std::find_if(lines.begin(), lines.end(), is_wanted);
    if (found == lines.end()) {
      text_.fail(table.start, fmt::format("the table of {} has no record of JD {}; it has {}, from JD {} to JD {}",
                                          table.target.name, format_number(*wanted_), lines.size(),
                                          format_number(epoch_at(table, lines.front())),
                                          format_number(epoch_at(table, lines.back()))));
    }
    const std::size_t end = found + 1 == lines.end() ? table.end : found[1];
    return table.headings.empty() ? text_record(table, *found, end) : record_of_fields(table, *found);
  }

  Record record_of_fields(const HorizonsTable& table, std::size_t line) const {
    Record record;
    record.line = line;
    const std::vector<std::string> fields = split_at(at(line), table.separator);
    const std::size_t count = std::min(fields.size(), table.headings.size());
    record.epoch = epoch_at(table, line);
    for (std::size_t k = 1; k < count; ++k) {
      const Heading heading = parse_heading(table.headings[k]);
      if (std::find(components.begin(), components.end(), heading.name) != components.end()) {
        record.values[heading.name] = number_in(text_, line, fields[k], heading.name);
      }
      if (heading.name == "mass") record.mass = mass_in(text_, units_, line, heading, fields[k]);
    }
    return record;
  }

  /// "2451545.000000000 = A.D. 2000-Jan-01 12:00:00.0000 TDB", then "X = ... Y = ... Z = ..." with or without labels.
  Record text_record(const HorizonsTable& table, std::size_t first, std::size_t end) const {
    Record record;
    record.line = first;
    record.epoch = epoch_at(table, first);
    std::size_t unlabeled = 0;
    for (std::size_t line = first + 1; line < end; ++line) read_numbers(line, record, unlabeled);
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
  std::optional<double> wanted_;  ///< epoch
  BodyList list_;
  std::vector<Body> bodies_;
  std::optional<HorizonsTable> first_;
  std::optional<double> epoch_, center_mass_;
};

}  // namespace

BodyTable read_horizons_bodies(const TextFile& text, const BodiesOptions& options) {
  return HorizonsBodies(text, options).read();
}

}  // namespace noether::io

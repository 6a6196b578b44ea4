#include "scene/reader.hpp"

#include "numbers/text.hpp"
#include "scene/foreign_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

/// An option as it was typed; a very long one is cut.
std::string option_text(const std::string& set) {
  constexpr std::size_t most = 200;
  const std::string text = set.starts_with(until_option) ? set : "--set " + set;
  return text.size() <= most ? text : valid_utf8(std::string_view(text).substr(0, most)) + "...";
}

}  // namespace

SceneError scene_error(const SceneSource& source, int line, std::string key, std::string value,
                       const std::string& message) {
  const auto set = static_cast<std::size_t>(-(line + 1));
  if (line < 0 && set < source.sets.size()) {
    return SceneError(option_text(source.sets[set]) + ": " + message,
                      {.key = std::move(key), .value = std::move(value)});
  }
  return SceneError(message, {.file = source.file, .line = line, .key = std::move(key), .value = std::move(value)});
}

TableReader::TableReader(const SceneContext& context, const SceneValue& table, std::string what, std::string path)
    : context_(context), table_(table), what_(std::move(what)), path_(std::move(path)) {
  if (!table_.is_table()) {
    throw scene_error(context_.source, table_.line, path_, to_text(table_),
                      fmt::format("{} is {}; a table is expected", what_, kind_of(table_)));
  }
}

const SceneValue* TableReader::find(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  return table_.find(key);
}

std::string TableReader::path_of(std::string_view key) const {
  if (key.empty()) return path_;
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

void TableReader::fail(const SceneValue* at, std::string_view key, const std::string& message) const {
  throw scene_error(context_.source, at != nullptr ? at->line : table_.line, path_of(key),
                    at != nullptr ? to_text(*at) : "", message);
}

void TableReader::note(const SceneValue& value, const std::string& message) const {
  if (context_.notes == nullptr) return;
  context_.notes->push_back(scene_error(context_.source, value.line, "", "", message).what());
}

void TableReader::refuse(const Error& error) const {
  const SceneValue* written = error.key().empty() ? nullptr : table_.find(error.key());
  const std::string start = error.key() + " = " + error.value();
  std::string message = error.message();
  if (written != nullptr && message.starts_with(start)) {
    message.replace(0, start.size(), error.key() + " = " + to_text(*written));
  }
  fail(written, error.key(), message);
}

void TableReader::wrong_kind(const SceneValue& value, std::string_view key, std::string_view expected) const {
  fail(&value, key, fmt::format("{} = {} is {}; {} is expected", key, to_text(value), kind_of(value), expected));
}

std::string TableReader::text(std::string_view key, std::string fallback) {
  const SceneValue* value = find(key);
  if (value == nullptr) return fallback;
  const std::string* text = value->get<std::string>();
  if (text == nullptr) wrong_kind(*value, key, "a text in quotes");
  return *text;
}

bool TableReader::flag(std::string_view key, bool fallback) {
  const SceneValue* value = find(key);
  if (value == nullptr) return fallback;
  const bool* flag = value->get<bool>();
  if (flag == nullptr) wrong_kind(*value, key, "true or false");
  return *flag;
}

std::optional<std::int64_t> TableReader::integer(std::string_view key) {
  const SceneValue* value = find(key);
  if (value == nullptr) return {};
  const auto* integer = value->get<std::int64_t>();
  const double* number = value->get<double>();
  // 1e6 is a natural way to write a million.
  if (number != nullptr && std::abs(*number) < 9e15 && *number == std::round(*number)) {
    return static_cast<std::int64_t>(*number);
  }
  if (integer == nullptr) wrong_kind(*value, key, "a whole number");
  return *integer;
}

void TableReader::expect_same_constant(double G) const {
  if (!(G > 0) || !(context_.G || context_.gravitates)) return;  // what is no constant is told by whoever wants one
  const double known = context_.G ? number(*context_.G, "G", "length^3/mass/time^2") : context_.units->G;
  if (G == known) return;
  std::string where = "of the units";
  if (context_.G && context_.G->line > 0) where = fmt::format("in line {}", context_.G->line);
  if (context_.G && context_.G->line == 0) where = "of the scene";
  fail("G", fmt::format("G = {} differs from the G = {} {}; a scene has only one gravitational constant: give it once, "
                        "as G in [hamiltonian]",
                        format_number(G), format_number(known), where));
}

void TableReader::expect_same_rate(double Omega) const {
  if (!context_.Omega || path_ == "hamiltonian") return;
  const double known = number(*context_.Omega, "Omega", "1/time");
  // As near as one value in two units is.
  if (std::abs(Omega - known) <= 1e-12 * std::abs(known)) return;
  const std::string where = context_.Omega->line > 0 ? fmt::format(" in line {}", context_.Omega->line) : "";
  fail("Omega", fmt::format("Omega = {} differs from the Omega = {}{} of the sheet; give it once, in [hamiltonian]",
                            to_text(*table_.find("Omega")), to_text(*context_.Omega), where));
}

double TableReader::number(const SceneValue& value, std::string_view key, std::string_view dimension) const {
  const UnitSystem& units = *context_.units;
  const Dimension expected = parse_dimension(dimension);
  const auto* integer = value.get<std::int64_t>();
  const double* number = value.get<double>();
  const std::string* text = value.get<std::string>();
  const bool angle = dimension == "angle";
  if (integer == nullptr && number == nullptr && text == nullptr) {
    const std::string example = angle ? "1 deg" : example_of(expected, "1", units);
    const bool bare = units.is_reduced() || (expected == dimensions::none && !angle);
    wrong_kind(value, key, bare ? "a number" : fmt::format("a quantity in quotes, such as \"{}\",", example));
  }
  if (text == nullptr) {
    const double bare = integer != nullptr ? static_cast<double>(*integer) : *number;
    if (!std::isfinite(bare)) {
      fail(&value, key, fmt::format("{} = {} is not finite; a finite number is expected", key, to_text(value)));
    }
    if (units.is_reduced() || (expected == dimensions::none && !angle) || key == "G") return bare;
  }
  const std::string written = text != nullptr ? *text : to_text(value);
  try {
    return angle ? parse_angle(written, units) : parse_quantity(written, expected, units);
  } catch (const Error& error) {
    fail(&value, key, fmt::format("{}: {}", key, error.message()));
  }
}

std::optional<double> TableReader::quantity(std::string_view key, std::string_view dimension) {
  const SceneValue* value = find(key);
  if (value == nullptr) return {};
  return number(*value, key, dimension);
}

std::optional<std::array<double, 3>> TableReader::vector(std::string_view key, std::string_view dimension) {
  const SceneValue* value = find(key);
  if (value == nullptr) return {};
  const auto* list = value->get<SceneValue::Array>();
  if (list == nullptr || list->size() != 3) {
    fail(value, key,
         fmt::format("{} = {} is not a vector; a list of three numbers is expected: [x, y, z]", key, to_text(*value)));
  }
  std::array<double, 3> result{};
  for (std::size_t k = 0; k < 3; ++k) result[k] = number((*list)[k], key, dimension);
  return result;
}

void TableReader::finish() const {
  for (const auto& [key, value] : std::get<SceneValue::Table>(table_.data)) {
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    const std::string in = what_.empty() ? "" : " in " + what_;
    fail(&value, key, fmt::format("unknown key '{}'{}{}", key, in, key_proposal(key, known_)));
  }
}

std::optional<std::vector<double>> TableReader::row(const ColumnInfo& column) {
  const SceneValue* value = find(column.name);
  if (value == nullptr) return {};
  if (column.width == 1) return std::vector<double>{number(*value, column.name, column.dimension)};
  const auto* list = value->get<SceneValue::Array>();
  if (list == nullptr || list->size() != static_cast<std::size_t>(column.width)) {
    fail(value, column.name, fmt::format("{} = {} is not a list of {}", column.name, to_text(*value), column.width));
  }
  std::vector<double> numbers;
  for (const SceneValue& one : *list) numbers.push_back(number(one, column.name, column.dimension));
  return numbers;
}

std::vector<const SceneValue*> tables_of(TableReader& reader, std::string_view key) {
  std::vector<const SceneValue*> tables;
  const SceneValue* value = reader.find(key);
  if (value == nullptr) return tables;
  const auto* list = value->get<SceneValue::Array>();
  const std::string name = reader.path_of(key);
  if (list == nullptr) {
    reader.fail(value, key, fmt::format("{} is {}; tables headed [[{}]] are expected", name, kind_of(*value), name));
  }
  for (const SceneValue& element : *list) {
    if (!element.is_table()) {
      reader.fail(&element, key,
                  fmt::format("{} contains {}; tables headed [[{}]] are expected", name, kind_of(element), name));
    }
    tables.push_back(&element);
  }
  return tables;
}

}  // namespace noether

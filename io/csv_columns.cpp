#include "io/csv_columns.hpp"

#include "engine/given_orbit.hpp"
#include "numbers/error.hpp"
#include "numbers/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace noether::io {

std::vector<std::string> names_of(const ColumnInfo& column) {
  if (column.width == 1) return {column.name};
  std::vector<std::string> names;
  for (int k = 0; k < column.width; ++k) names.push_back(fmt::format("{}[{}]", column.name, k));
  return names;
}

namespace {

/// " [km]": of numbers in the units of a run; "" where they have none.
std::string unit_of_column(const ColumnInfo& column, const UnitSystem& units) {
  if (units.is_reduced() || column.dimension == "1") return "";
  if (column.dimension == "angle") return " [rad]";
  try {
    return fmt::format(" [{}]", unit_of(parse_dimension(column.dimension), units));
  } catch (const Error&) {
    throw Error(fmt::format("a column '{}', whose unit is not known", column.name));
  }
}

}  // namespace

std::vector<std::string> headings_of(const ColumnInfo& column, const UnitSystem& units) {
  const std::string unit = unit_of_column(column, units);
  BodiesOptions options;
  options.columns = {column};
  const std::vector<KnownColumn> known = known_columns(options);
  std::vector<std::string> headings;
  for (const std::string& name : names_of(column)) {
    const auto same =
        std::count_if(known.begin(), known.end(), [&](const KnownColumn& one) { return one.name == name; });
    if (same != 1 || name.find_first_of(",\"#\t\n") != std::string::npos || heading_of(name + unit, known).name != name)
      throw Error(fmt::format("a column '{}', a name that tables have for something else or cannot write", name));
    headings.push_back(name + unit);
  }
  return headings;
}

std::vector<KnownColumn> known_columns(const BodiesOptions& options) {
  std::vector<KnownColumn> columns = {{"name", ""},
                                      {"id", ""},
                                      {"mass", "mass"},
                                      {"x", "length", "position"},
                                      {"y", "length", "position"},
                                      {"z", "length", "position"},
                                      {"vx", "velocity", "velocity"},
                                      {"vy", "velocity", "velocity"},
                                      {"vz", "velocity", "velocity"},
                                      {"about", ""}};
  for (const OrbitKey& key : orbit_keys)
    columns.push_back({std::string(key.name), std::string(key.dimension), key.dimension == "angle" ? "angle" : ""});
  for (const auto* list : {&options.columns, &options.left_out}) {
    for (const ColumnInfo& column : *list) {
      for (const std::string& name : names_of(column))
        columns.push_back({name, column.dimension, column.width > 1 ? column.name : ""});
    }
  }
  return columns;
}

Heading heading_of(const std::string& field, const std::vector<KnownColumn>& known) {
  for (const KnownColumn& column : known) {
    if (column.name.back() != ']' || !field.starts_with(column.name)) continue;
    const Heading heading = parse_heading(trimmed(std::string_view(field).substr(column.name.size())));
    if (heading.name.empty()) return {column.name, heading.unit};
  }
  return parse_heading(field);
}

}  // namespace noether::io

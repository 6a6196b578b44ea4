#include "io/csv_columns.hpp"

#include "engine/given_orbit.hpp"

#include <fmt/format.h>

namespace noether::io {

std::vector<std::string> names_of(const ColumnInfo& column) {
  if (column.width == 1) return {column.name};
  std::vector<std::string> names;
  for (int k = 0; k < column.width; ++k) names.push_back(fmt::format("{}[{}]", column.name, k));
  return names;
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

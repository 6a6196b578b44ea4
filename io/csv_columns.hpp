#pragma once
/// The columns that a CSV table of bodies may have, as it is read and as it is written.

#include "engine/columns.hpp"
#include "io/body_table.hpp"
#include "io/text_table.hpp"

#include <string>
#include <vector>

namespace noether::io {

/// What a table may hold; `dimension` in words, "" for what is no number. A unit serves all columns of a group.
struct KnownColumn {
  std::string name, dimension;
  std::string group = {};  ///< "position", "velocity", "angle", or the name of a column of several numbers; or none
};

/// Names of the numbers of a column of particles: "radius", or "spin[0]", "spin[1]", "spin[2]" as `convert` writes
/// them.
std::vector<std::string> names_of(const ColumnInfo& column);

/// What stands in the first line of a table for a column of particles, with the units of a run.
/// @throws Error  where a reader would take that for something else, or the unit is not known
std::vector<std::string> headings_of(const ColumnInfo& column, const UnitSystem& units);

/// All columns, in the order in which messages list them.
std::vector<KnownColumn> known_columns(const BodiesOptions& options);

/// A heading; the brackets behind the name of a column of several numbers say which of them.
Heading heading_of(const std::string& field, const std::vector<KnownColumn>& known);

}  // namespace noether::io

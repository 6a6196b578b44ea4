#pragma once
/// What every part says of itself, as `noether describe` shows it.

#include "scene/json.hpp"
#include "scene/parts.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace noether {

/// Every part but the methods, with its kind: "force", "monitor". The keys that name particles stand before its own.
std::vector<std::pair<std::string, PartInfo>> described_parts(const Parts& parts);

/// Where in a scene parts of a kind stand, and when they look.
std::string table_of(const std::string& kind);

/// Keys as a list of JSON objects.
Json json_of(const std::vector<FieldInfo>& fields);
Json json_of(const std::vector<ColumnInfo>& columns);

/// Keys that bodies have because of a part, each with its dimension: `radius` [length].
/// @param mark  around the names
std::vector<std::string> texts_of(const std::vector<ColumnInfo>& columns, std::string_view mark = "");

/// The entries of docs/references.bib for the sources "A, B", one below the other.
std::string entries_of(std::string_view sources);

}  // namespace noether

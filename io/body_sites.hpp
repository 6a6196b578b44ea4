#pragma once
/// Sites of a rigid body from a table.

#include "engine/bodies.hpp"
#include "numbers/units.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace noether::io {

/// Reads the sites of a rigid body from CSV: the first line names the columns, `x [km],y,z,mass [kg]`, and optionally
/// `charge`, `type` and `name`. A unit stands once for the three places; the reduced system has none.
/// @param types  names of types; a table with none has no column `type`
/// @throws FileError if the file cannot be read or is no text; SceneError for what is wrong in it, with file and line
/// @cost O(bytes)
std::vector<BodySite> read_body_sites(const std::filesystem::path& file, const UnitSystem& units,
                                      const std::vector<std::string>& types = {});

}  // namespace noether::io

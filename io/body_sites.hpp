#pragma once
/// Sites of a rigid body from a table.

#include "engine/bodies.hpp"
#include "numbers/units.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace noether::io {

/// The types that sites may have.
struct SiteTypes {
  std::vector<std::string> names = {};
  std::vector<double> charges = {};  ///< of sites that are given none; empty, or one for each type [charge]

  double charge(int type) const { return charges.empty() ? 0 : charges[static_cast<std::size_t>(type)]; }
};

/// Reads the sites of a rigid body from CSV: the first line names the columns, `x [km],y,z,mass [kg]`, and optionally
/// `charge`, `type` and `name`. A unit stands once for the three places; the reduced system has none.
/// @param types  where there are several, the table has a column `type`, and without a column `charge` their charges
/// @throws FileError if the file cannot be read or is no text; SceneError for what is wrong in it, with file and line
/// @cost O(bytes)
std::vector<BodySite> read_body_sites(const std::filesystem::path& file, const UnitSystem& units,
                                      const SiteTypes& types = {});

}  // namespace noether::io

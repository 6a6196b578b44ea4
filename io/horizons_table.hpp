#pragma once
/// Vector tables of JPL Horizons: their heads, and where their records stand.

#include "io/text_table.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace noether::io {

/// A body or barycenter as Horizons names it: "Jupiter Barycenter (5)".
struct HorizonsObject {
  std::string text;           ///< as it stands there
  std::string name;           ///< without the number
  std::optional<int> number;  ///< in parentheses at the end, if one is there

  bool operator==(const HorizonsObject&) const = default;
};

/// GM of a body that Horizons names, or of a planet with its moons where it names a barycenter [km^3/s^2]; empty if it
/// is not built in.
/// @throws std::bad_alloc
std::optional<double> known_GM(const HorizonsObject& object);

/// One table: what its head says, and where its records stand (lines counted from 1).
struct HorizonsTable {
  HorizonsObject target, center;
  std::string frame;  ///< with the plane of old tables; two spellings of one frame are the same here
  std::string units, time_scale;
  std::optional<double> mass, center_mass;  ///< lines that a user has put in
  std::vector<std::string> headings;        ///< of a table of fields; empty where records are text
  char separator = ',';                     ///< of these fields
  std::size_t target_line = 0, start = 0, end = 0;
};

/// The next table at or after a line; empty if there is none.
/// @throws SceneError for one without end, and for states that are no geometric vectors about the center of a body
std::optional<HorizonsTable> next_horizons_table(const TextFile& text, const UnitSystem& units, std::size_t line);

/// A mass under a heading such as "mass [kg]" [mass]. @throws SceneError
double mass_in(const TextFile& text, const UnitSystem& units, std::size_t line, const Heading& heading,
               std::string_view word);

}  // namespace noether::io

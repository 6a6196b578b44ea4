#pragma once
/// Bodies of a table, what reading them takes, and what the table says of them.

#include "engine/particle_system.hpp"
#include "numbers/units.hpp"

#include <optional>
#include <string>
#include <vector>

namespace noether::io {

/// What the orbits of a table are about, unless its column `about` names another body.
enum class ElementsAbout {
  first_body,    ///< mu = G (m_0 + m)
  all_before_it  ///< the barycenter of all bodies before it, Jacobi's elements: mu = G (m_0 + ... + m)
};

/// What a table of bodies does not say itself.
struct BodiesOptions {
  const UnitSystem* units = &unit_system("solar");  ///< the unit system of the particles
  std::optional<double> G = {};  ///< constant of gravitation [length^3/mass/time^2]; default: the unit system's own
  ElementsAbout elements = ElementsAbout::first_body;
  std::optional<double> epoch = {};  ///< Julian day of the start: the records to take of Horizons (default: the first);
                                     ///< beside it stand times of the pericenter in Julian days
  std::vector<ColumnInfo> columns = {};   ///< of particles, that a CSV table may give
  std::vector<ColumnInfo> left_out = {};  ///< that it may have, but nobody uses
};

/// The moment for which the states of a table hold.
struct BodyEpoch {
  double julian_day = 0;
  std::string scale;  ///< "TDB", as the table has it; empty if it does not say
};

/// Whether a number of days from the start is rather a Julian day, of the years 1311 to 2406: six or seven thousand
/// years are not counted in days.
/// @throws never
constexpr bool looks_like_julian_day(double days) { return days > 2.2e6 && days < 2.6e6; }

/// Whether a Julian day is so many days from the epoch that one of the two is a modified Julian day, which counts from
/// 2400000.5.
/// @throws never
constexpr bool is_modified_beside(double days) { return days > 2e6 || days < -2e6; }

/// Bodies, and what a table says of them.
struct BodyTable {
  ParticleSystem<double> particles;
  std::optional<BodyEpoch> epoch = {};     ///< of Horizons, or as it was given
  bool without_sun = false;                ///< states about the Solar System Barycenter, and no Sun among them
  std::vector<std::string> left_out = {};  ///< columns that it has, and nobody uses
  std::string light_center = {};           ///< a warning: orbits about the first body, and a heavier one above
};

}  // namespace noether::io

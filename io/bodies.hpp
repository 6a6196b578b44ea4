#pragma once
/// Bodies from tables: CSV files, and vector tables as JPL Horizons prints them.

#include "engine/particle_system.hpp"
#include "numbers/units.hpp"

#include <filesystem>
#include <optional>

namespace noether::io {

/// What a table of bodies does not say itself.
struct BodiesOptions {
  const UnitSystem* units = &unit_system("solar");  ///< the unit system of the particles
  std::optional<double> G = {};  ///< constant of gravitation [length^3/mass/time^2]; default: the unit system's own
};

/// Reads bodies; a table with a line "$$SOE" is one of Horizons, anything else is CSV.
///
/// CSV: the first line names the columns, with the unit in brackets (none in the reduced system, which has radians for
/// angles): `mass [Msun]`, and `x [au],y,z,vx [au/day],vy,vz` or the elements `a [au],e,inc [deg],Omega [deg],omega
/// [deg], M [deg]` about the first body, mu = G (m_0 + m), which itself stands at rest in the origin and leaves its
/// elements empty; also `name` (default: body_1, body_2, ...) and `id` (default: 0, 1, ...). `#` begins a comment, a
/// field may stand in double quotes.
///
/// Horizons: any number of vector tables of one epoch, frame and center, one per body; of each the first record counts.
/// Horizons gives no masses: mass = GM / G with GM from DE440, by body number, unless the table has a column
/// `mass [kg]` or, before "$$SOE", a line `mass [kg] = 1.9e27`.
/// @throws FileError if the file cannot be read or is no text; SceneError for what is wrong in it, with file and line
/// @cost O(bytes)
/// @source Park2021
ParticleSystem<double> read_bodies(const std::filesystem::path& file, const BodiesOptions& options = {});

}  // namespace noether::io

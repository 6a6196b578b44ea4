#pragma once
/// Bodies from tables: CSV files, and vector tables as JPL Horizons prints them.

#include "io/body_table.hpp"

#include <filesystem>

namespace noether::io {

/// Reads bodies from CSV, or from vector tables of JPL Horizons, as text or as the JSON of its API.
///
/// CSV: the first line names the columns, with units in brackets: `mass [Msun]`, and `x [au],y,z,vx [au/day],vy,vz` or
/// orbital elements such as `a [au],e,inc [deg],Omega,omega,M`; also `name`, `id`, `about`. A unit stands once or more
/// for each of the groups of positions, velocities and angles; the reduced system has none, and radians. Fields are
/// separated by commas, semicolons, tabs or blanks.
///
/// Horizons: any number of vector tables of one epoch, frame and center, one per body. The center joins them at rest in
/// the origin, unless it is a barycenter. mass = GM / G with GM from DE440, by body number, or from a line
/// `mass [kg] = ...` that stands before "$$SOE". docs/bodies.md has all of it.
/// @throws FileError if the file cannot be read or is no text; SceneError for what is wrong in it, with file and line
/// @cost O(bytes)
/// @source Park2021
BodyTable read_body_table(const std::filesystem::path& file, const BodiesOptions& options = {});

/// The particles alone.
ParticleSystem<double> read_bodies(const std::filesystem::path& file, const BodiesOptions& options = {});

}  // namespace noether::io

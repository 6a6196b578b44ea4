#pragma once
/// What the readers of structures share: units of files, particles before they are put together, words and numbers.

#include "engine/particle_system.hpp"
#include "io/structure_options.hpp"
#include "io/text_table.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace noether::io {

enum class StructureFormat : std::uint8_t { lammps_data, extended_xyz, gro };

/// Factors that take numbers of a file to the units of the particles: number times factor.
struct FileUnits {
  double length = 1, velocity = 1, energy = 1;
  double momentum_velocity = 1;  ///< of a momentum in sqrt(eV u) over a mass in u, as velocity
};

/// The units of a file of this format.
/// @throws Error  at key "file_units" or "units" where they do not fit each other
FileUnits file_units_of(StructureFormat format, const StructureOptions& options);

/// Particles as a file lists them, in the units of the particles.
struct Structure {
  std::vector<std::int64_t> ids;
  std::vector<std::string> names;
  std::vector<double> masses;  ///< not a number: unknown
  std::vector<Vec3<double>> x, v;
  std::vector<Vec3<std::int32_t>> images;  ///< empty: none were given
  std::vector<double> charges;             ///< empty: none were given
  Box box;
  Topology topology;
};

/// The standard atomic weight of an element [u]; not a number for what is none, or has none.
/// @throws never
/// @source Meija2016
double standard_atomic_weight(std::string_view element);

/// Parts a line at blanks, and leaves out what stands behind `#`.
void split_words(std::string_view line, std::vector<std::string_view>& words);

/// Reads a whole number from `least` to `most`; `what` names it in messages. @throws SceneError
std::int64_t whole_number_in(const TextFile& text, std::size_t line, std::string_view word, std::string_view what,
                             std::int64_t least, std::int64_t most);

/// The box of three edges as numbers of a file. @throws SceneError
Box box_in(const TextFile& text, std::size_t line, const Vec3<double>& edges);

/// The most particles a file is believed to have.
inline constexpr std::int64_t most_particles = 1'000'000'000;
/// The most types of particles or terms.
inline constexpr std::int64_t most_types = 100'000;

Structure read_lammps_data(const TextFile& text, const FileUnits& units, const StructureOptions& options);
Structure read_extended_xyz(const TextFile& text, const FileUnits& units);
Structure read_gro(const TextFile& text, const FileUnits& units);

}  // namespace noether::io

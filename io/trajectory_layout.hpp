#pragma once
/// Where things stand in run.h5: the writer, the reader and the inspector agree on it here.

#include "io/hdf5_file.hpp"
#include "numbers/error.hpp"
#include "numbers/units.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace noether::io {

inline const std::string particles_path = "/particles/system";
inline const std::string image_path = "/particles/system/image";
inline const std::string edges_path = "/particles/system/box/edges";
inline const std::string sites_path = "/particles/sites";
inline const std::string system_path = "/noether/system";
inline const std::string monitors_path = "/noether/monitors";

/// Attribute of the group of a column that moves beyond position and velocity: what it is to forces.
inline const std::string role_attribute = "noether_role";

/// Attribute of a column: the dimension of its numbers in words, from which its unit follows.
inline const std::string dimension_attribute = "noether_dimension";

/// Names of the columns of a file that move beyond position and velocity, in their order.
inline std::vector<std::string> moving_columns(const Hdf5File& file) {
  std::vector<std::string> names;
  for (const std::string& name : file.children(particles_path)) {
    const std::string group = particles_path + "/" + name;
    if (file.is_group(group) && file.has_attribute(group, role_attribute)) names.push_back(name);
  }
  return names;
}

/// Whether a dataset is the one that readers go by: on disk nothing of its group is ever shorter. These are positions
/// of frames, variables of a system and steps of samples.
inline bool is_leader(const std::string& path) {
  return path == particles_path + "/position/value" || path == system_path + "/value" ||
         (path.starts_with(monitors_path) && path.ends_with("/step"));
}

/// Rows to a piece on disk: whole pages of 4096 bytes, at least `wanted` bytes, where that stays below 1 MiB.
Index rows_per_chunk(Index numbers_per_row, Index wanted);
inline constexpr Index frame_bytes = 65536, sample_bytes = 4096;

/// The unit of a dimension in words, or those of a list of dimensions, one for each column; words that are no dimension
/// stand for themselves.
std::string unit_in_words(const std::string& dimension, const UnitSystem& units);

/// The unit system that a file names. @throws FileError if there is none of this name
inline const UnitSystem& known_units(const std::string& name, const std::filesystem::path& file) {
  try {
    return unit_system(name);
  } catch (const Error&) {
    throw FileError("damaged: its unit system '" + name + "' is unknown", {.file = file.string()});
  }
}

}  // namespace noether::io

#pragma once
/// Where things stand in run.h5: the writer, the reader and the inspector agree on it here.

#include "engine/error.hpp"
#include "engine/units.hpp"

#include <filesystem>
#include <string>

namespace noether::io {

inline const std::string particles_path = "/particles/system";
inline const std::string image_path = particles_path + "/image";
inline const std::string edges_path = particles_path + "/box/edges";
inline const std::string system_path = "/noether/system";
inline const std::string monitors_path = "/noether/monitors";

/// Whether a dataset is the one that readers go by: on disk nothing of its group is ever shorter. These are positions
/// of frames, variables of a system and steps of samples.
inline bool is_leader(const std::string& path) {
  return path == particles_path + "/position/value" || path == system_path + "/value" ||
         (path.starts_with(monitors_path) && path.ends_with("/step"));
}

/// The unit system that a file names. @throws FileError if there is none of this name
inline const UnitSystem& known_units(const std::string& name, const std::filesystem::path& file) {
  try {
    return unit_system(name);
  } catch (const Error&) {
    throw FileError("damaged: its unit system '" + name + "' is unknown", {.file = file.string()});
  }
}

}  // namespace noether::io

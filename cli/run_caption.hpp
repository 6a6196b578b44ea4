#pragma once
/// What stands over the picture of a run: its title, its method, a unit of time that people read.

#include "scene/value.hpp"

#include <filesystem>
#include <string>

namespace noether {

class Parts;

struct RunCaption {
  std::string title;            ///< of the scene, or the name of the folder of the run
  std::string method;           ///< "wisdom_holman, aba_10_6_4, step 100 day"
  std::string time_unit;        ///< "kyr"; empty in reduced units
  double time_length = 1;       ///< of that unit [time]
  bool energy_changes = false;  ///< the scene has drag, a bath, or a force that depends on time
};

/// The scene that a file was made from. @throws FileError  if it cannot be read
SceneValue scene_in_file(const std::string& toml, const std::filesystem::path& file);

/// @param longest  the largest time that is shown [time]
RunCaption caption_of(const SceneValue& scene, const std::filesystem::path& file, const std::string& time_unit,
                      double longest, const Parts& parts);

}  // namespace noether

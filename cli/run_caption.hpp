#pragma once
/// What stands over the picture of a run: its title, its method, a unit of time that people read.

#include "scene/value.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

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

/// The value of a dotted key of the stored scene; null if it is not there.
const SceneValue* value_at(const SceneValue& scene, const std::vector<std::string_view>& keys);
/// The same as text; "" if it is not there.
std::string text_at(const SceneValue& scene, const std::vector<std::string_view>& keys);

/// @param longest  the largest time that is shown [time]
RunCaption caption_of(const SceneValue& scene, const std::filesystem::path& file, const std::string& time_unit,
                      double longest, const Parts& parts);

}  // namespace noether

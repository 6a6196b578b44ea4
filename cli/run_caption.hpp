#pragma once
/// What stands over the picture of a run: its title, its method, a unit of time that people read.

#include "scene/value.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

class Parts;

/// A unit in which people read a time.
struct ReadableTime {
  std::string unit;   ///< its name; empty in reduced units
  double length = 1;  ///< of the unit, in the unit of the file
};

struct RunCaption {
  std::string title;            ///< of the scene, or the name of the folder of the run
  std::string method;           ///< "wisdom_holman, aba_10_6_4, step 100 day"
  ReadableTime time;            ///< "kyr" and its length
  bool energy_changes = false;  ///< the scene has drag, a bath, or a force that depends on time
};

/// The scene that a file was made from. @throws FileError  if it cannot be read
SceneValue scene_in_file(const std::string& toml, const std::filesystem::path& file);

/// The value of a dotted key of the stored scene; null if it is not there.
const SceneValue* value_at(const SceneValue& scene, const std::vector<std::string_view>& keys);
/// The same as text; "" if it is not there.
std::string text_at(const SceneValue& scene, const std::vector<std::string_view>& keys);

/// The tables of a list such as `[[hamiltonian.force]]`; none where it is not there.
std::vector<const SceneValue*> tables_at(const SceneValue& scene, const std::vector<std::string_view>& keys);

/// The unit for times up to `longest` in a unit of the file: yr, kyr or Myr instead of days, ns instead of ps.
ReadableTime readable_time(const std::string& unit, double longest);

/// What chooses the unit of times from `begin` to `end`: how long that is; of one moment how far it is from 0. [time]
double shown_time(double begin, double end);

/// @param longest  what chooses the unit: `shown_time` of what is shown [time]
RunCaption caption_of(const SceneValue& scene, const std::filesystem::path& file, const std::string& time_unit,
                      double longest, const Parts& parts);

}  // namespace noether

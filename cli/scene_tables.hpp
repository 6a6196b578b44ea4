#pragma once
/// The tables of a scene and the keys that stand in them whatever parts the scene names.

#include "scene/parts.hpp"

#include <string>
#include <vector>

namespace noether {

/// One table of a scene.
struct SceneTable {
  std::string name;               ///< as a scene writes its head: "[[particles.body]]"; empty: above all tables
  std::string help;               ///< one sentence
  std::vector<FieldInfo> fields;  ///< in the order in which people write them
};

/// Every table of a scene, in the order in which scenes have them.
std::vector<SceneTable> scene_tables(const Parts& parts);

}  // namespace noether

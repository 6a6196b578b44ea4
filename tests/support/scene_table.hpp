#pragma once
/// The table of scenes that must be refused: tests/scenes/bad/scenes.txt, as tests/scenes/README.md explains it.

#include <filesystem>
#include <string>
#include <vector>

namespace noether::test {

struct TableScene {
  std::string name, text;
};

struct SceneTable {
  std::vector<TableScene> good;  ///< what the bad ones are changed from
  std::vector<TableScene> bad;
};

/// @throws std::runtime_error with the line if a row does not fit the scene that it changes, changes nothing, or has
/// the name of another
SceneTable scene_table(const std::string& text);

struct SceneFiles {
  std::vector<std::filesystem::path> good, bad;
};
/// Writes every scene of the table as NAME.toml into `folder`/bad, beside copies of the files that they read.
SceneFiles write_scene_table(const std::filesystem::path& folder);

}  // namespace noether::test

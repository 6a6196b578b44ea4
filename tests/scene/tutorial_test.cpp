/// The scenes of docs/scenes.md: each can be saved in the folder of the repository and run as it stands.

#include "scene/minimize.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace noether::test {
namespace {

std::vector<std::string> scenes_in(const std::string& page) {
  const std::string begin = "```toml\n", end = "```\n";
  std::vector<std::string> scenes;
  for (std::size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at)) {
    at += begin.size();
    scenes.push_back(page.substr(at, page.find(end, at) - at));
  }
  return scenes;
}

}  // namespace

TEST_CASE("the scenes of the tutorial docs/scenes.md can be run", "[scene][docs]") {
  const std::filesystem::path root = NOETHER_SOURCE_DIR;
  const std::vector<std::string> scenes = scenes_in(read_text(root / "docs" / "scenes.md"));
  CHECK(scenes.size() == 6);
  for (const std::string& text : scenes) {
    INFO(text);
    Scene scene = read_scene(text, root / "scene.toml");
    CHECK(scene.warnings.empty());
    if (scene.minimize) CHECK(minimize_start(scene).converged());
    CHECK(assemble(scene).run(20).ok());
  }
}

TEST_CASE("the first scene of the tutorial has five lines and needs no output tables", "[scene][docs]") {
  const std::filesystem::path root = NOETHER_SOURCE_DIR;
  const std::string first = scenes_in(read_text(root / "docs" / "scenes.md")).at(0);
  CHECK(std::count(first.begin(), first.end(), '\n') == 5);
  CHECK(first.find("every") == std::string::npos);
  CHECK(read_scene(first, root / "scene.toml").particles.size() == 3);
}

}  // namespace noether::test

// Scenes of tests/scenes: the good ones load and run, the bad ones are refused to the letter.

#include "io/digest.hpp"
#include "numbers/error.hpp"
#include "scene/scene.hpp"
#include "scene/toml.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/process.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scene_table.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace noether::test {
namespace {

const std::filesystem::path scenes = std::filesystem::path(NOETHER_SOURCE_DIR) / "tests" / "scenes";

std::vector<std::filesystem::path> good_scenes() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(scenes / "good")) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// What a bad scene says of itself: see tests/scenes/README.md.
struct Expected {
  std::vector<std::string> sets;
  std::string message;
  int line = 0;  ///< 0: the message stands for itself, file included
  int exit_code = 2;
  int messages = 0;
};

Expected expected_of(const std::filesystem::path& file) {
  Expected expected;
  std::istringstream text(read_text(file));
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    if (line.starts_with("#!set ")) {
      expected.sets.push_back(line.substr(6));
    } else if (line.starts_with("#!exit ")) {
      expected.exit_code = std::stoi(line.substr(7));
    } else if (line.starts_with("#!! ")) {
      expected.message = line.substr(4);
      ++expected.messages;
    } else if (const auto at = line.find("#! "); at != std::string::npos) {
      expected.message = line.substr(at + 3);
      expected.line = number;
      ++expected.messages;
    }
  }
  return expected;
}

/// The message of an error as the program shows it in the folder of the scene.
std::string without_folder(std::string text, const std::filesystem::path& folder) {
  const std::string prefix = folder.string() + "/";
  for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) text.erase(at, prefix.size());
  return text;
}

TEST_CASE("every bad scene is refused with its message, at its line", "[scene]") {
  const ScratchFolder folder;
  const SceneFiles files = write_scene_table(folder.path());
  const std::string promised = "| " + std::to_string(files.bad.size()) + " scenes, each with its message inside";
  CHECK(has(read_text(std::filesystem::path(NOETHER_SOURCE_DIR) / "docs/promises.md"), promised));
  for (const auto& file : files.bad) {
    const Expected expected = expected_of(file);
    INFO(file.filename().string());
    REQUIRE(expected.messages == 1);
    try {
      load_scene(file, standard_parts(), expected.sets);
      FAIL_CHECK("the scene was taken");
    } catch (const Error& error) {
      CHECK(error.exit_code() == expected.exit_code);
      if (expected.line > 0) {
        CHECK(without_folder(error.message(), file.parent_path()) == expected.message);
        CHECK(error.line() == expected.line);
        CHECK(error.file() == file.string());
      } else {
        CHECK(without_folder(error.what(), file.parent_path()) == expected.message);
      }
    }
  }
}

TEST_CASE("what the bad scenes are changed from is good", "[scene]") {
  const ScratchFolder folder;
  for (const auto& file : write_scene_table(folder.path()).good) {
    INFO(file.filename().string());
    CHECK(refusal_of([&] { load_scene(file); }) == "");
  }
}

/// What is wrong with a row of the table.
std::string wrong_row(const std::string& row) {
  try {
    scene_table("==== good\na = 1\nb = 2\na = 3\n\n== bad\n" + row);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST_CASE("a row of the table changes what it names, in order", "[scene]") {
  const std::string good = "==== good\na = 1\nb = 2\na = 3\n\n";
  CHECK(scene_table(good + "== bad\n#!exit 3\n  b = 2\n= a = 4  #! no\n+\n+ c = 5\n\n").bad.at(0).text ==
        "#!exit 3\na = 1\nb = 2\na = 4  #! no\n\nc = 5\n");
  CHECK(scene_table(good + "== bad\n- a = 3\n").bad.at(0).text == "a = 1\nb = 2\n");
  const std::string lost = "is not found in the scene that is changed, below the change before";
  CHECK(wrong_row("= c = 1\n") == "line 7: '= c = 1' " + lost);
  CHECK(wrong_row("- b = 2\n  a = 1\n") == "line 8: '  a = 1' " + lost);
  CHECK(wrong_row("  b = 2\n") == "line 6: '== bad' changes nothing");
  CHECK(wrong_row("b = 3\n") == "line 7: 'b = 3' begins with none of '+', '-', '=' and ' '");
  CHECK(wrong_row("- b = 2\n== good\n") == "line 8: '== good' appears twice");
}

Outcome run_to_its_end(Simulation<double>& sim, const Scene& scene) {
  const SceneIntegrator& made = scene.integrator;
  return made.until ? sim.run_until(*made.until) : sim.run(*made.steps);
}

TEST_CASE("every good scene runs, and so does the scene that its files store", "[scene]") {
  const auto files = good_scenes();
  REQUIRE(files.size() >= 4);
  for (const auto& file : files) {
    INFO(file.filename().string());
    const Scene scene = load_scene(file);
    Simulation<double> sim = assemble(scene);
    const Outcome outcome = run_to_its_end(sim, scene);
    CHECK(outcome.kind == Outcome::Kind::completed);

    const Scene again = read_scene(scene.effective_toml, file);
    CHECK(again.effective_toml == scene.effective_toml);
    Simulation<double> other = assemble(again);
    CHECK(run_to_its_end(other, again).kind == Outcome::Kind::completed);
    CHECK(io::digest(other.particles()) == io::digest(sim.particles()));
  }
}

TEST_CASE("a body table that has changed since is refused by its hash", "[scene]") {
  const std::filesystem::path file = scenes / "good" / "from_csv.toml";
  std::string text = load_scene(file).effective_toml;
  const auto at = text.find("bodies_sha256 = \"") + 17;
  text[at] = text[at] == '0' ? '1' : '0';
  try {
    read_scene(text, file);
    FAIL("the scene was taken");
  } catch (const SceneError& error) {
    CHECK(error.key() == "particles.bodies_sha256");
    CHECK(error.message().find("differs from the file this scene was run with") != std::string::npos);
  }
}

}  // namespace
}  // namespace noether::test

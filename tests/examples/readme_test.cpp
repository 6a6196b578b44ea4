/// README.md: its program and its scene do what it says, its links lead somewhere, and it answers the first questions
/// of a new user.

#include "tests/examples/readme.hpp"
#include "scene/run.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"

#define main ten_lines
#include "tests/examples/ten_lines.inc"
#undef main

#include <algorithm>
#include <filesystem>
#include <regex>
#include <string>

namespace examples {
namespace {

const std::filesystem::path root = NOETHER_SOURCE_DIR;

std::string readme() { return noether::test::read_text(root / "README.md"); }

/// The first block of the README that is fenced by ```LANGUAGE.
std::string block_of(const std::string& text, const std::string& language) {
  const std::string begin = "\n```" + language + "\n";
  const std::size_t at = text.find(begin);
  REQUIRE(at != std::string::npos);
  return text.substr(at + begin.size(), text.find("```\n", at + begin.size()) - at - begin.size());
}

/// The part of a page below a heading, up to the next one of its level.
std::string section(const std::string& page, const std::string& heading) {
  const std::size_t at = page.find("\n## " + heading + "\n");
  INFO(heading);
  REQUIRE(at != std::string::npos);
  return page.substr(at, page.find("\n## ", at + 4) - at);
}

/// The folders of examples that a text links to.
std::vector<std::string> linked_examples(const std::string& text) {
  const std::regex link(R"(\]\(examples/(\w+)\))");
  std::vector<std::string> names;
  for (std::sregex_iterator at(text.begin(), text.end(), link), end; at != end; ++at) names.push_back((*at)[1].str());
  return names;
}

}  // namespace

TEST_CASE("the ten lines of the README are these, and run", "[examples][slow]") {
  CHECK(block_of(readme(), "cpp") == noether::test::read_text(root / "tests/examples/ten_lines.inc"));
  const noether::test::ScratchFolder scratch;
  std::filesystem::copy(root / "examples/outer_solar_system/outer_planets.csv", scratch.path());
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(scratch.path());
  const int code = ten_lines();
  std::filesystem::current_path(before);
  CHECK(code == 0);
}

TEST_CASE("the README's first scene has eight lines, and conserves energy to rounding as it says", "[examples][docs]") {
  const std::string scene = block_of(readme(), "toml");
  CHECK(std::count(scene.begin(), scene.end(), '\n') == 8);
  noether::Simulation<double> sim = assemble(noether::read_scene(scene, root / "halley.toml"));
  auto& energy = sim.every(1, noether::Energy{});
  REQUIRE(sim.run_until(300 * noether::units::solar::year).ok());
  CHECK(energy.worst() < 5e-15);
}

TEST_CASE("the README prints of the outer Solar System what the example prints", "[examples][docs]") {
  const std::string page = readme(), begin = "\n```\ncompleted at step ";
  const std::size_t at = page.find(begin);
  REQUIRE(at != std::string::npos);
  const std::string printed = page.substr(at + 5, page.find("```\n", at + 5) - at - 5);
  const auto outputs = outputs_in(readme_of("outer_solar_system"));
  REQUIRE(outputs.size() == 2);
  CHECK(physics(printed, Bits::everywhere) == physics(outputs[1], Bits::everywhere));
}

TEST_CASE("the README answers what a new user asks first", "[examples][docs]") {
  const std::string page = readme();
  // Can it do mine?
  const std::string mine = section(page, "Can it do mine?");
  CHECK(mine.find("| I want to | example |") != std::string::npos);
  CHECK(mine.find("**What it cannot do yet:**") != std::string::npos);
  std::vector<std::string> linked = linked_examples(mine), there;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_directory()) there.push_back(entry.path().filename().string());
  }
  std::sort(linked.begin(), linked.end());
  std::sort(there.begin(), there.end());
  CHECK(linked == there);
  // How do I start?
  const std::string start = section(page, "How do I start?");
  for (const char* part : {"\n./noether run examples/", "\n./noether test ", "about eight minutes", "noether plot ",
                           "noether view ", "--resume", "### A scene of your own"}) {
    CAPTURE(part);
    CHECK(start.find(part) != std::string::npos);
  }
  // How right and how fast is it beside what I use?
  const std::string beside = section(page, "How right, how fast?");
  for (const char* part : {"worst energy error", "REBOUND ", "heyoka ", "LAMMPS ", "| other programs |",
                           "same core of that processor", "not fast yet"}) {
    CAPTURE(part);
    CHECK(beside.find(part) != std::string::npos);
  }
}

TEST_CASE("every link of the README and of the pages of docs leads to a file", "[examples][docs]") {
  const std::regex link(R"(\]\(([^)#:\s]+)(#[^)\s]*)?\))");
  std::vector<std::filesystem::path> pages;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "docs")) pages.push_back(entry.path());
  for (const auto& entry : std::filesystem::directory_iterator(root)) pages.push_back(entry.path());
  for (const auto& entry : std::filesystem::directory_iterator(folder)) pages.push_back(entry.path() / "README.md");
  int links = 0;
  for (const std::filesystem::path& page : pages) {
    if (page.extension() != ".md" || !std::filesystem::exists(page)) continue;
    const std::string text = noether::test::read_text(page);
    for (std::sregex_iterator at(text.begin(), text.end(), link), end; at != end; ++at, ++links) {
      CAPTURE(page.string(), (*at)[1].str());
      CHECK(std::filesystem::exists(page.parent_path() / (*at)[1].str()));
    }
  }
  CHECK(links > 60);
}

}  // namespace examples

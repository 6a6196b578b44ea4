/// The ten lines that README.md shows compile as they stand there, and do what they say.

#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"

#define main ten_lines
#include "tests/examples/ten_lines.inc"
#undef main

#include <filesystem>

TEST_CASE("the ten lines of the README are these, and run", "[examples][slow]") {
  const std::filesystem::path root = NOETHER_SOURCE_DIR;
  const std::string readme = test::read_text(root / "README.md");
  CHECK(readme.find("```cpp\n" + test::read_text(root / "tests/examples/ten_lines.inc") + "```") != readme.npos);
  const test::ScratchFolder scratch;
  std::filesystem::copy(root / "examples/outer_solar_system/outer_planets.csv", scratch.path());
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(scratch.path());
  const int code = ten_lines();
  std::filesystem::current_path(before);
  CHECK(code == 0);
}

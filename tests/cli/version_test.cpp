// What the program tells of itself: its version, and its help.

#include "tests/cli/support.hpp"

#include "io/hdf5_file.hpp"
#include "numbers/parallel.hpp"
#include "numbers/simd.hpp"
#include "numbers/version.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace noether::test {
namespace {

TEST_CASE("version tells what was built, and what this machine has", "[cli][version]") {
  const ScratchFolder folder;
  CHECK(output(folder, "--version") == fmt::format("noether {} ({})\n", version(), commit()));
  const std::string json = output(folder, "version --json");
  CHECK(is_json_line(json));
  CHECK(json_member(json, "schema") == "\"noether.version/1\"");
  CHECK(json_member(json, "version") == fmt::format("\"{}\"", version()));
  CHECK(json_member(json, "commit") == fmt::format("\"{}\"", commit()));
  CHECK(json_member(json, "simd") == fmt::format("\"{}\"", name(simd_level())));
  CHECK(json_member(json, "threads") == std::to_string(thread_count()));
#if NOETHER_HDF5
  CHECK(json_member(json, "hdf5") == fmt::format("\"{}\"", io::hdf5_version()));
  CHECK(io::hdf5_version().starts_with("1."));
#else
  CHECK(json_member(json, "hdf5") == "null");
#endif
  std::string compiler = json_member(json, "compiler");
  CHECK((compiler.starts_with("\"g++ ") || compiler.starts_with("\"clang++ ")));
  std::erase(compiler, '"');

  const std::vector<std::string> lines = lines_of(output(folder, "version"));
  REQUIRE(lines.size() == 6);
  CHECK(lines[0] == fmt::format("noether     {}", version()));
  CHECK(lines[1] == fmt::format("commit      {}", commit()));
  CHECK(lines[2] == "compiler    " + compiler);
  CHECK(lines[4] == fmt::format("SIMD level  {}", name(simd_level())));
}

TEST_CASE("the release, its change log and its citation name one version", "[cli][version]") {
  const std::string root = NOETHER_SOURCE_DIR "/", number = version();
  CHECK(has(read_text(root + "CMakeLists.txt"), "project(noether VERSION " + number + " "));
  const std::string changes = read_text(root + "CHANGELOG.md"), citation = read_text(root + "CITATION.cff");
  const std::string heading = "\n## " + number + " - ";
  CHECK(changes.starts_with("# Changelog\n\n## Unreleased\n"));
  const std::size_t release = changes.find("\n## ", changes.find("## Unreleased"));
  REQUIRE(release != std::string::npos);
  CHECK(changes.substr(release, heading.size()) == heading);  // the newest of all
  const std::string date = changes.substr(release + heading.size(), 10);
  CHECK(has(citation, "\nversion: " + number + "\n"));
  CHECK(has(citation, "\ndate-released: \"" + date + "\"\n"));
}

TEST_CASE("help is that of the program, or of a command", "[cli][help]") {
  const ScratchFolder folder;
  const std::string help = output(folder, "help");
  CHECK(help == output(folder, "--help"));
  for (const char* name : {"run", "plot", "help", "version"}) {
    CHECK(has(help, std::string("\n  ") + name + " "));
    CHECK(output(folder, std::string("help ") + name) == output(folder, std::string(name) + " --help"));
  }
  CHECK_FALSE(has(help, "./noether"));  // an installed program has no launcher

  const auto launched = [&](const std::string& line) {
    std::vector<std::string> all = command(line);
    all.insert(all.begin(), {"env", "NOETHER_LAUNCHER=/somewhere/noether"});
    return run_process(all, folder.path());
  };
  for (const char* line : {"help", "--help"}) {
    const std::string text = launched(line).out;
    for (const char* name : {"build", "test", "bench", "wheel"})
      CHECK(has(text, std::string("\n  ./noether ") + name + " "));
    CHECK(text.starts_with(help));
  }
  CHECK(launched("biuld").err == "unknown command 'biuld'; did you mean 'build'?\n");
}

}  // namespace
}  // namespace noether::test

/// The examples that are ensembles: the commands of their READMEs, typed as they are printed, say what the READMEs
/// print.

#include "tests/examples/readme.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/process.hpp"

#include <algorithm>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#if NOETHER_HDF5

namespace examples {
namespace {

namespace fs = std::filesystem;

struct EnsembleExample {
  std::string name;
  bool long_run = false;  ///< more than twenty seconds
};

// Starts are orbital elements, whose sines are those of the library: digests are those of this machine.
const std::vector<EnsembleExample> ensembles = {
    {"double_pendulums", true}, {"kirkwood_gaps", true}, {"megno_map"}, {"trappist_1"}, {"trojans_and_plutinos", true},
};

std::vector<std::string> lines_that_begin(const std::string& page, const std::string& begin) {
  std::vector<std::string> lines;
  std::istringstream all(page);
  for (std::string line; std::getline(all, line);) {
    if (line.starts_with(begin)) lines.push_back(line);
  }
  return lines;
}

/// Without how long members took.
std::string without_times(const std::string& output) {
  return std::regex_replace(output, std::regex("(^|\n)[0-9]+ members? in [^\n]*"), "$1");
}

void check_ensembles(bool long_runs) {
  for (const EnsembleExample& example : ensembles) {
    if (example.long_run != long_runs) continue;
    CAPTURE(example.name);
    const std::string page = readme_of(example.name);
    const std::vector<std::string> commands = lines_that_begin(page, "./noether ensemble "), shown = outputs_in(page);
    REQUIRE(!commands.empty());
    REQUIRE(shown.size() == commands.size());
    const noether::test::ScratchFolder reader;
    fs::create_symlink(NOETHER_PROGRAM, reader.path() / "noether");
    fs::create_symlink(folder, reader.path() / "examples");
    for (std::size_t k = 0; k < commands.size(); ++k) {
      CAPTURE(commands[k]);
      const auto result = noether::test::run_process({"bash", "-c", commands[k]}, reader.path());
      CHECK(result.exit_code == 0);
      CHECK(result.err.empty());
      CHECK(physics(without_times(result.out), Bits::of_this_machine) ==
            physics(without_times(shown[k]), Bits::of_this_machine));
      // What is there is told again, without a run.
      const auto again = noether::test::run_process({"bash", "-c", commands[k]}, reader.path());
      CHECK(digest_in(again.out) == digest_in(result.out));
    }
    const bool draws = noether::test::run_process({"gnuplot", "--version"}, reader.path()).exit_code == 0;
    for (const std::string& line : lines_that_begin(page, "./noether plot ")) {
      if (!draws) continue;
      CAPTURE(line);
      CHECK(noether::test::run_process({"bash", "-c", line}, reader.path()).exit_code == 0);
    }
  }
}

}  // namespace

TEST_CASE("every example without a program of its own is an ensemble that is tested", "[examples]") {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory() && !fs::exists(entry.path() / "main.cpp"))
      names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  REQUIRE(names.size() == ensembles.size());
  for (std::size_t k = 0; k < names.size(); ++k) {
    CAPTURE(names[k]);
    CHECK(ensembles[k].name == names[k]);
    const std::string page = readme_of(names[k]);
    CHECK(page.starts_with("# "));
    for (const std::string& output : outputs_in(page)) CHECK(digest_in(output).size() == 7 + 64);
    CHECK(fs::exists(folder / names[k] / "draw.py"));
    CHECK(fs::exists(folder / names[k] / (names[k] + ".png")));
  }
}

TEST_CASE("ensembles of examples print what their READMEs print", "[examples][ensemble][slow]") {
  check_ensembles(false);
}
TEST_CASE("long ensembles of examples print what their READMEs print", "[examples][ensemble][.][nightly]") {
  check_ensembles(true);
}

}  // namespace examples

#endif

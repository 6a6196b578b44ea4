/// What each README of examples/ prints as expected output is what the example really gives.

#include "examples/oblate_saturn/oblateness.hpp"

#include "engine/monitors.hpp"
#include "engine/orbital_monitors.hpp"
#include "engine/simulation.hpp"
#include "engine/units.hpp"
#include "forces/check_gradient.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/linear_drag.hpp"
#include "forces/sum.hpp"
#include "integrators/composition.hpp"
#include "integrators/damped.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/schemes.hpp"
#include "integrators/wisdom_holman.hpp"
#include "io/bodies.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "scene/run.hpp"
#include "tests/examples/example_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#define main program
namespace readme::driven_oscillator {
#include "examples/driven_oscillator/main.cpp"
}
namespace readme::figure_eight {
#include "examples/figure_eight/main.cpp"
}
namespace readme::kepler {
#include "examples/kepler/main.cpp"
}
namespace readme::oblate_saturn {
#include "examples/oblate_saturn/main.cpp"
}
namespace readme::outer_solar_system {
#include "examples/outer_solar_system/main.cpp"
}
namespace readme::pythagorean {
#include "examples/pythagorean/main.cpp"
}
namespace readme::solar_system {
#include "examples/solar_system/main.cpp"
}
namespace readme::template_project {
#include "examples/template_project/main.cpp"
}
#undef main

namespace {

namespace fs = std::filesystem;

/// Whether the last digit of a mathematical function can change a run: only figures far above rounding are then fixed.
enum class Bits : std::uint8_t { everywhere, of_this_machine };

std::string readme_of(const std::string& example) {
  std::ifstream in(fs::path(NOETHER_SOURCE_DIR) / "examples" / example / "README.md");
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The blocks fenced by ```text, in order: what the program prints, what the scene reports.
std::vector<std::string> outputs_in(const std::string& readme) {
  static constexpr std::string_view begin = "```text\n", end = "```\n";
  std::vector<std::string> blocks;
  for (std::size_t at = readme.find(begin); at != readme.npos; at = readme.find(begin, at)) {
    at += begin.size();
    const std::size_t stop = readme.find(end, at);
    if (stop == readme.npos) break;
    blocks.push_back(readme.substr(at, stop - at));
    at = stop + end.size();
  }
  return blocks;
}

/// The lines that are physics: without times of the machine and names of files, and without what bits decide where
/// these are of this machine only: the digest, and figures of 1e-12 and less.
std::string physics(const std::string& output, Bits bits) {
  static const std::regex machine("steps/s on|^wrote "), digest("^sha256:"), rounding("-?[0-9.]+e-(1[2-9]|[2-9][0-9])");
  std::string kept;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_search(line, machine)) continue;
    if (bits == Bits::of_this_machine && std::regex_search(line, digest)) continue;
    if (bits == Bits::of_this_machine) line = std::regex_replace(line, rounding, "(rounding)");
    kept += line + "\n";
  }
  return kept;
}

noether::Parts parts_of(const std::string& example) {
  noether::Parts parts = noether::standard_parts();
  if (example == "oblate_saturn") parts.add_force<Oblateness>();
  return parts;
}

void check_program(const std::string& example, int (*program)(), Bits bits = Bits::everywhere) {
  const auto expected = outputs_in(readme_of(example));
  REQUIRE(!expected.empty());
  if (!noether::programs_can_run) return;
  const noether::ExampleFolder folder(example);
  CHECK(physics(noether::output_of(program), bits) == physics(expected[0], bits));
}

void check_scene(const std::string& example, Bits bits = Bits::everywhere) {
  const auto expected = outputs_in(readme_of(example));
  REQUIRE(expected.size() == 2);
  if (!noether::programs_can_run) return;
  const noether::ExampleFolder folder(example);
  const noether::Scene scene = noether::load_scene("scene.toml", parts_of(example));
  CHECK(physics(to_text(run(scene, {.handle_signals = false})), bits) == physics(expected[1], bits));
}

}  // namespace

TEST_CASE("every example has a README that names its scene, with the outputs of program and scene", "[examples]") {
  int examples = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(NOETHER_SOURCE_DIR) / "examples")) {
    if (!entry.is_directory()) continue;
    const std::string example = entry.path().filename().string(), readme = readme_of(example);
    const bool has_scene = fs::exists(entry.path() / "scene.toml");
    CAPTURE(example);
    CHECK(readme.find("# ") == 0);
    if (has_scene) CHECK(readme.find("./noether run examples/" + example + "/scene.toml") != readme.npos);
    const auto outputs = outputs_in(readme);
    CHECK(outputs.size() == (has_scene ? 2 : 1));
    for (const std::string& output : outputs) CHECK(noether::digest_in(output) == noether::digest_in(outputs[0]));
    ++examples;
  }
  CHECK(examples == 8);
}

TEST_CASE("the READMEs of the quick examples print what program and scene give", "[examples]") {
  check_program("kepler", readme::kepler::program);
  check_scene("kepler");
  check_program("figure_eight", readme::figure_eight::program);
  check_scene("figure_eight");
  check_program("driven_oscillator", readme::driven_oscillator::program, Bits::of_this_machine);
  check_scene("driven_oscillator", Bits::of_this_machine);
  check_program("template_project", readme::template_project::program);
}

TEST_CASE("the README of the solar system prints what program and scene give", "[examples][slow]") {
  check_program("solar_system", readme::solar_system::program);
  check_scene("solar_system");
}

TEST_CASE("the README of the oblate Saturn prints what program and scene give", "[examples][slow]") {
  check_program("oblate_saturn", readme::oblate_saturn::program, Bits::of_this_machine);
  check_scene("oblate_saturn", Bits::of_this_machine);
}

TEST_CASE("the README of the outer solar system prints what program and scene give", "[examples][.][nightly]") {
  check_program("outer_solar_system", readme::outer_solar_system::program);
  check_scene("outer_solar_system");
}

TEST_CASE("the README of the Pythagorean problem prints what program and scene give", "[examples][.][nightly]") {
  check_program("pythagorean", readme::pythagorean::program);
  check_scene("pythagorean");
}

TEST_CASE("a stale figure in a README is seen, times of the machine are not", "[examples]") {
  const std::string readme = readme_of("kepler");
  REQUIRE(outputs_in(readme).size() == 2);
  const std::string output = outputs_in(readme)[1];
  const auto changed = [&](const char* from, const char* to) {
    return physics(std::regex_replace(output, std::regex(from), to), Bits::everywhere) !=
           physics(output, Bits::everywhere);
  };
  CHECK(changed("sha256:.", "sha256:x"));
  CHECK(changed("worst .", "worst x"));
  CHECK_FALSE(changed("steps in [^:]*", "steps in 9 s"));
}

/// The commands of README.md and of the tutorial docs/scenes.md are typed as they are printed, in a folder where the
/// program is called ./noether and the scenes of these pages are saved under the names that the pages give them. Long
/// scenes end sooner.

#include "tests/support/catch.hpp"
#include "tests/support/json.hpp"
#include "tests/support/process.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <regex>
#include <string>
#include <vector>

#if NOETHER_HDF5

namespace examples {
namespace {

namespace fs = std::filesystem;
using noether::test::has;
using noether::test::ProcessResult;
using noether::test::read_text;
using noether::test::write_text;

const fs::path root = NOETHER_SOURCE_DIR;

/// Every match of a pattern's first group.
std::vector<std::string> found_in(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at) found.push_back((*at)[1]);
  return found;
}

/// The commands of a page in its order: lines that begin with `./noether`, without their comments, and those in a
/// sentence.
std::vector<std::string> commands_in(const std::string& page) {
  return found_in(page, R"((?:\n *|`)(\./noether [^`#\n]*[^`#\n ]))");
}

/// Text with every key of `changes` replaced.
std::string changed(std::string text, const std::map<std::string, std::string>& changes) {
  for (const auto& [from, to] : changes) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
      text.replace(at, from.size(), to);
    }
  }
  return text;
}

/// A folder as the reader of a page has it: the program, the examples, and the scenes of the page.
class Reader : public noether::test::ScratchFolder {
 public:
  explicit Reader(const std::string& page, const std::map<std::string, std::string>& shorter = {}) {
    fs::create_symlink(NOETHER_PROGRAM, path() / "noether");
    fs::create_symlink(root / "examples", path() / "examples");
    const std::string begin = "```toml\n";
    for (std::size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at)) {
      const std::vector<std::string> names = found_in(page.substr(0, at), "`(\\w+\\.toml)`");
      REQUIRE_FALSE(names.empty());
      at += begin.size();
      INFO(names.back() << " is the last name before this scene");
      REQUIRE_FALSE(fs::exists(path() / names.back()));
      write_text(path() / names.back(), changed(page.substr(at, page.find("```\n", at) - at), shorter));
      ++scenes_;
    }
  }

  int scenes() const { return scenes_; }

  /// Types a line in a shell; the command must end with that code, and say nothing but notes and, where `warns`,
  /// warnings.
  std::string type(const std::string& line, int exit_code = 0, bool warns = false) {
    const ProcessResult result = noether::test::run_process({"bash", "-c", line}, path());
    INFO(line << "\n" << result.out << result.err);
    CHECK(result.exit_code == exit_code);
    if (exit_code == 0 && !warns) {
      for (const std::string& said : noether::test::lines_of(result.err)) CHECK(said.starts_with("note: "));
    }
    ++typed_;
    return result.out;
  }
  int typed() const { return typed_; }

 private:
  int scenes_ = 0, typed_ = 0;
};

/// Whether a picture can be drawn here; says so once where it cannot.
bool draws(const Reader& reader) {
  if (noether::test::run_process({"gnuplot", "--version"}, reader.path()).exit_code == 0) return true;
  WARN("gnuplot is not installed: the pictures are left out");
  return false;
}

bool is_study(const std::string& line) {
  return std::regex_search(line, std::regex("noether (compare|advise|stability) "));
}

std::string tutorial() { return read_text(root / "docs/scenes.md"); }
std::string readme() { return read_text(root / "README.md"); }

/// The worst error in a report, as the pages print it.
std::string worst(const std::string& report, const std::string& monitor) {
  using noether::test::json_member;
  const std::string figure = json_member(json_member(json_member(report, "monitors"), monitor), "worst");
  return fmt::format("{:.1e}", std::strtod(figure.c_str(), nullptr));
}

}  // namespace

TEST_CASE("the commands of the tutorial do what it says, typed as they are printed", "[examples][docs]") {
  Reader reader(tutorial(), {{"\"1000 yr\"", "\"20 yr\""}, {"\"100 yr\"", "\"1 yr\""}});
  CHECK(reader.scenes() == 6);
  const bool pictures = draws(reader);
  std::map<std::string, std::string> printed;
  for (const std::string& line : commands_in(tutorial())) {
    if (is_study(line) || (!pictures && has(line, " plot "))) continue;
    // Runs that are not the same: that is what the exit code says.
    printed[line] = reader.type(line, has(line, "--against") ? 3 : 0);
    if (line == "./noether explain saturn.toml") CHECK(has(reader.type("./noether run saturn.toml"), "completed"));
    if (line.starts_with("./noether describe")) {  // the page says next what it has of the second scene
      for (const char* part : {"J2", "radius", "[length]"}) CHECK(has(printed[line], part));
    }
  }
  CHECK(reader.typed() >= 18);
  CHECK(has(printed["./noether run comet.toml"], "wrote comet.out/run.h5\n"));
  CHECK(has(printed["./noether run comet.toml --resume --until \"600 yr\""], "completed at step "));
  CHECK(has(printed["./noether verify planets.out/run.h5 --against fine/run.h5"], "they differ"));
  CHECK(read_text(reader.path() / "comet.html").starts_with("<!DOCTYPE html>"));
  if (pictures) CHECK(read_text(reader.path() / "comet.png").starts_with("\x89PNG"));
  CHECK(fs::exists(reader.path() / "comet.out.1/run.h5"));
  for (const char* scene : {"argon.toml", "pendulum.toml", "reactions.toml"}) {
    CHECK(has(reader.type(fmt::format("./noether run {}", scene)), "completed"));
  }
}

TEST_CASE("the studies of the tutorial give a table and an advice", "[examples][docs][slow]") {
  Reader reader(tutorial(), {{"\"1000 yr\"", "\"2 yr\""}});
  std::vector<std::string> lines = commands_in(tutorial());
  std::erase_if(lines, [](const std::string& line) { return !is_study(line) || has(line, "SCENE"); });
  REQUIRE(lines.size() == 2);
  const std::string table = reader.type(changed(lines[0], {{"100 yr", "1 yr"}}) + " --methods aba_10_6_4,gauss_8");
  CHECK(has(table, "aba_10_6_4"));
  CHECK(fs::exists(reader.path() / "planets.out/report.html"));
  CHECK(has(reader.type(lines[1] + " --methods aba_10_6_4,gauss_8"), "\ncheapest: "));
}

TEST_CASE("the commands of the README do what it says, typed as they are printed", "[examples][docs]") {
  Reader reader(readme());
  CHECK(reader.scenes() == 1);
  const bool pictures = draws(reader);
  for (std::string line : commands_in(readme())) {
    if (line.starts_with("./noether test") || line.starts_with("./noether wheel") || has(line, "/NAME/")) continue;
    if (is_study(line) || (!pictures && has(line, " plot "))) continue;
    if (has(line, "outer_solar_system/scene.toml")) line += " --until \"1000 yr\"";
    reader.type(changed(line, {{"SCENE", "halley.toml"}}));
  }
  CHECK(reader.typed() >= 7);
  CHECK(has(reader.type("./noether run halley.toml --resume"), "completed at step "));
  CHECK(fs::exists(reader.path() / "halley.out/run.h5"));
  CHECK(read_text(reader.path() / "orbits.html").starts_with("<!DOCTYPE html>"));
  if (pictures) CHECK(read_text(reader.path() / "orbits.png").starts_with("\x89PNG"));
}

TEST_CASE("the studies that the README names answer about an example", "[examples][docs][slow]") {
  Reader reader(readme());
  std::vector<std::string> lines = commands_in(readme());
  std::erase_if(lines, [](const std::string& line) { return !is_study(line); });
  REQUIRE(lines.size() == 3);
  const auto answer = [&](const std::string& line, const std::string& shorter) {
    return reader.type(changed(line, {{"SCENE", "examples/figure_eight/scene.toml"}}) + shorter);
  };
  CHECK(has(answer(lines[0], " --methods gauss_8,verlet"), "verlet"));
  CHECK(has(answer(lines[1], " --methods gauss_8,verlet"), "\ncheapest: "));
  CHECK(has(answer(lines[2], " --methods verlet --steps 2000"), "\nverlet "));
}

TEST_CASE("the errors in the README's table repeat to the last digit, as it says", "[examples][docs][slow]") {
  Reader reader(readme());
  const std::string page = readme();
  const std::regex row(R"(\n\| ([^|\n]*) \| [^|\n]* \| (\d\.\de-\d\d) \| (\d\.\de-\d\d)? ?\|)");
  std::string scene;
  int rows = 0;
  for (std::sregex_iterator at(page.begin(), page.end(), row), end; at != end; ++at) {
    const std::string first = (*at)[1];
    INFO(first);
    for (const std::string& name : found_in(first, "`(\\w+)`")) scene = name;
    const std::vector<std::string> options = found_in(first, "`(--[^`]*)`");
    // The million years are run by examples_test.cpp, at night.
    if (options.empty() && scene == "outer_solar_system") continue;
    const std::string report = reader.type(
        fmt::format("./noether run examples/{}/scene.toml --fresh --json {}", scene, fmt::join(options, " ")));
    CHECK(worst(report, "energy") == (*at)[2].str());
    if ((*at)[3].matched) CHECK(worst(report, "angular_momentum") == (*at)[3].str());
    ++rows;
  }
  CHECK(rows == 5);
}

/// What a row "| options | what they show |" of an example's README says about the run: its exit code, and its outcome.
void check_change(Reader& reader, const std::string& command, const std::string& shows) {
  const bool refused = shows.starts_with("refused: ");
  const std::vector<std::string> failed = found_in(shows, R"(^(?:fails|diverged) at step (\d+))");
  const std::string report = reader.type(command + " --fresh --json", refused ? 2 : failed.empty() ? 0 : 1, true);
  if (!failed.empty()) CHECK(noether::test::json_member(report, "step") == failed[0]);
  for (const std::string& figure : found_in(shows, R"((?:^|worst energy error |energy's worst is )(\d\.\de-\d\d)\b)")) {
    CHECK(worst(report, "energy") == figure);
  }
  for (const std::string& steps : found_in(shows, R"(^(\d+) steps\b)")) {
    CHECK(noether::test::json_member(report, "step") == steps);
  }
}

TEST_CASE("what the examples' READMEs say of changed scenes is so", "[examples][docs][.][nightly]") {
  Reader reader(readme());
  int changes = 0;
  const std::regex checkable(R"(^refused: |^(fails|diverged) at step |^\d+ steps\b|^\d\.\de-|)"
                             R"((worst energy error|energy's worst is) \d\.\de-)");
  for (const auto& entry : fs::directory_iterator(root / "examples")) {
    const std::string page = read_text(entry.path() / "README.md");
    const std::vector<std::string> commands = found_in(page, R"(\nTry \(`(\./noether run [^`]*)`)");
    // The crystal's table has two columns of errors; of liquids at night what other tests do not run is left out.
    if (commands.empty() || entry.path().filename() == "argon_crystal") continue;
    const std::regex row(R"(\n\| `(--[^`\n]*)` \| ([^\n]*) \|)");
    for (std::sregex_iterator at(page.begin(), page.end(), row), end; at != end; ++at) {
      const std::string options = (*at)[1], shows = (*at)[2];
      if (!std::regex_search(shows, checkable)) continue;
      INFO(entry.path().filename().string() << ": " << options << ": " << shows);
      check_change(reader, commands[0] + " " + options, shows);
      ++changes;
    }
  }
  CHECK(changes >= 35);
}

}  // namespace examples

#endif

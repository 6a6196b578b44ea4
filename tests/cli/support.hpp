#pragma once
/// What the tests of the program share: calls of it, its scenes, files that are compared or spoiled.

#include "tests/support/catch.hpp"
#include "tests/support/json.hpp"
#include "tests/support/process.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace noether::test {

/// The words of a command line: blanks part them, single quotes hold them together.
inline std::vector<std::string> words(std::string_view line) {
  std::vector<std::string> found;
  bool quoted = false, inside = false;
  for (const char c : line) {
    if (c == '\'') {
      quoted = !quoted;
      if (!inside) found.emplace_back();
      inside = true;
    } else if (c == ' ' && !quoted) {
      inside = false;
    } else {
      if (!inside) found.emplace_back();
      inside = true;
      found.back() += c;
    }
  }
  return found;
}

/// The program, or another one, with the words of a line as its arguments.
inline std::vector<std::string> command(std::string_view line, const char* program = NOETHER_PROGRAM) {
  std::vector<std::string> all{program};
  for (std::string& word : words(line)) all.push_back(std::move(word));
  return all;
}

/// Calls the program in a folder: `noether(folder, "run scene.toml --json")`.
inline ProcessResult noether(const ScratchFolder& folder, std::string_view line,
                             const char* program = NOETHER_PROGRAM) {
  return run_process(command(line, program), folder.path());
}

/// What a command says on stderr, but for where the finished run before it went.
inline std::string complaints(const std::string& err) {
  std::string rest;
  for (const std::string& line : lines_of(err)) {
    if (!line.starts_with("note: the finished run in ")) rest += line + "\n";
  }
  return rest;
}

/// The output of a command that must succeed and has nothing to complain of.
inline std::string output(const ScratchFolder& folder, const std::string& line, const char* program = NOETHER_PROGRAM) {
  const ProcessResult result = noether(folder, line, program);
  INFO(line << "\n" << result.out << result.err);
  CHECK(result.exit_code == 0);
  CHECK(complaints(result.err).empty());
  return result.out;
}

/// The same of the program with parts from outside the library (tests/cli/own_parts).
inline ProcessResult own(const ScratchFolder& folder, std::string_view line) {
  return noether(folder, line, NOETHER_OWN_PROGRAM);
}
inline std::string own_output(const ScratchFolder& folder, const std::string& line) {
  return output(folder, line, NOETHER_OWN_PROGRAM);
}

inline std::size_t line_count(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// Two bodies, a hundred steps: the shortest run that writes everything. Its last checkpoint but one is of step 80.
inline const std::string two_bodies = R"(title = "Two bodies"
units = "reduced"
[[particles.body]]
name = "Sun"
mass = 1
x = [0, 0, 0]
v = [0, 0, 0]
[[particles.body]]
name = "Planet"
mass = 0.001
x = [1, 0, 0]
v = [0, 1, 0]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "gravity"
[integrator]
method = "yoshida_4"
step = 0.01
steps = 100
[[every]]
type = "energy"
steps = 10
[[every]]
type = "angular_momentum"
steps = 7
[[every]]
type = "trajectory"
steps = 20
[[every]]
type = "checkpoint"
steps = 40
)";

/// Two bodies without files, also for builds that can write none.
inline const std::string unwritten = two_bodies.substr(0, two_bodies.find("[[every]]\ntype = \"trajectory\""));

/// A spring so stiff for its step that each step multiplies the amplitude by 98.
inline const std::string exploding = R"(units = "reduced"
[particles]
body = [{ name = "ball", mass = 1, x = [1, 0, 0], v = [0, 0, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "harmonic_field"
k = 100
[integrator]
method = "verlet"
step = 1
steps = 1000
[[every]]
type = "energy"
steps = 10
)";

/// A folder with `scene.toml` in it.
struct SceneFolder : ScratchFolder {
  explicit SceneFolder(const std::string& scene = two_bodies) { write_text(*this / "scene.toml", scene); }
};

/// Leaves the folder of a finished run as one that was killed after the checkpoint before its last.
inline void make_unfinished(const std::filesystem::path& out) {
  std::filesystem::rename(out / "checkpoint.previous.h5", out / "checkpoint.h5");
}

/// Changes one byte in the middle of a file.
inline void damage(const std::filesystem::path& file) {
  std::string bytes = read_text(file);
  REQUIRE_FALSE(bytes.empty());
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
  write_text(file, bytes);
}

/// What must not depend on whether and how often a run was stopped.
inline void check_same_run(const std::string& json, const std::string& whole) {
  INFO(json);
  REQUIRE(is_json_line(json));
  for (const char* key : {"outcome", "message", "step", "time", "digest", "scene_sha256"}) {
    CHECK(json_member(json, key) == json_member(whole, key));
  }
  CHECK(json_member(json, "outcome") == "\"completed\"");
  CHECK(json_member(json, "evaluations") == json_member(whole, "evaluations"));
  CHECK(json_member(json, "monitors") == json_member(whole, "monitors"));
  CHECK_FALSE(json_member(json, "monitors").empty());
}

/// The digest of a run of scene.toml by that program into a folder, with more options after it.
inline std::string own_digest(const ScratchFolder& folder, const std::string& line) {
  const std::string digest = json_member(own_output(folder, "run scene.toml --json --out " + line), "digest");
  CHECK(digest.size() > 10);
  return digest;
}

}  // namespace noether::test

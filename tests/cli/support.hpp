#pragma once
/// What the tests of the program share: calls of it, its scenes, files that are compared or spoiled.

#include "tests/support/catch.hpp"
#include "tests/support/process.hpp"

#include <algorithm>
#include <cctype>
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

/// The program with the words of a line as its arguments.
inline std::vector<std::string> command(std::string_view line) {
  std::vector<std::string> all{NOETHER_PROGRAM};
  for (std::string& word : words(line)) all.push_back(std::move(word));
  return all;
}

/// Calls the program in a folder: `noether(folder, "run scene.toml --json")`.
inline ProcessResult noether(const ScratchFolder& folder, std::string_view line) {
  return run_process(command(line), folder.path());
}

/// The output of a command that must succeed and say nothing on stderr.
inline std::string output(const ScratchFolder& folder, const std::string& line) {
  const ProcessResult result = noether(folder, line);
  INFO(line << "\n" << result.out << result.err);
  CHECK(result.exit_code == 0);
  CHECK(result.err.empty());
  return result.out;
}

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

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

/// Checks that two HDF5 files agree value for value, in every group, dataset and attribute.
inline void check_same_content(const std::filesystem::path& one, const std::filesystem::path& other) {
  const std::string python = NOETHER_PYTHON;
  const std::filesystem::path script = std::filesystem::path(NOETHER_SOURCE_DIR) / "tests/io/compare_files.py";
  ProcessResult result{77, "there is no Python\n", ""};
  const ScratchFolder folder;
  if (!python.empty())
    result = run_process({python, "-B", script.string(), one.string(), other.string()}, folder.path());
  if (result.exit_code == 77) {
    WARN("not compared: " << result.out);
    return;
  }
  INFO(result.out << result.err);
  CHECK(result.exit_code == 0);
}

/// Reads JSON as far as to say whether it is JSON.
class JsonCheck {
 public:
  explicit JsonCheck(std::string_view text) : rest_(text) {}
  bool whole() { return value() && rest_.empty(); }

 private:
  bool take(char c) {
    if (rest_.empty() || rest_[0] != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  bool word(std::string_view expected) {
    if (!rest_.starts_with(expected)) return false;
    rest_.remove_prefix(expected.size());
    return true;
  }
  bool string() {
    if (!take('"')) return false;
    while (!rest_.empty() && rest_[0] != '"') {
      if (static_cast<unsigned char>(rest_[0]) < ' ') return false;
      rest_.remove_prefix(std::min<std::size_t>(rest_[0] == '\\' ? 2 : 1, rest_.size()));
    }
    return take('"');
  }
  bool digits() {
    const std::size_t before = rest_.size();
    while (!rest_.empty() && std::isdigit(static_cast<unsigned char>(rest_[0])) != 0) rest_.remove_prefix(1);
    return rest_.size() < before;
  }
  bool number() {
    take('-');
    if (!digits() || (take('.') && !digits())) return false;
    if (!take('e')) return true;
    if (!take('-')) take('+');
    return digits();
  }
  template <class Item> bool items(char open, char close, const Item& item) {
    if (!take(open)) return false;
    if (take(close)) return true;
    do {
      if (!item()) return false;
    } while (take(','));
    return take(close);
  }
  bool value() {
    if (rest_.empty()) return false;
    if (rest_[0] == '{') return items('{', '}', [this] { return string() && take(':') && value(); });
    if (rest_[0] == '[') return items('[', ']', [this] { return value(); });
    return rest_[0] == '"' ? string() : word("null") || word("true") || word("false") || number();
  }

  std::string_view rest_;
};

/// Whether a text is one line that holds one JSON object.
inline bool is_json_line(const std::string& text) {
  return !text.empty() && text.back() == '\n' && line_count(text) == 1 && text[0] == '{' &&
         JsonCheck(std::string_view(text).substr(0, text.size() - 1)).whole();
}

/// What must not depend on whether and how often a run was stopped.
inline void check_same_run(const std::string& json, const std::string& whole) {
  INFO(json);
  REQUIRE(is_json_line(json));
  for (const char* key : {"outcome", "message", "step", "time", "digest", "scene_sha256"}) {
    CHECK(json_member(json, key) == json_member(whole, key));
  }
  CHECK(json_member(json, "outcome") == "\"completed\"");
  CHECK(json_block(json, "evaluations") == json_block(whole, "evaluations"));
  CHECK(json_block(json, "monitors") == json_block(whole, "monitors"));
  CHECK_FALSE(json_block(json, "monitors").empty());
}

}  // namespace noether::test

// The keys that `--set` proposes are those that tables take.

#include "scene/key_paths.hpp"

#include "numbers/text.hpp"
#include "scene/scene.hpp"
#include "scene/toml.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace noether::test {
namespace {

const std::string liquid = R"(units = "reduced"
[particles]
type = "liquid"
particles = 64
density = 0.8
mass = 1
[minimize]
max_force = 1
[hamiltonian]
type = "kinetic_potential"
force = [{type = "lennard_jones", epsilon = 1, sigma = 1, cutoff = 2}]
[hamiltonian.neighbors]
[integrator]
method = "verlet"
step = 0.01
)";

const std::string orbit = R"(units = "reduced"
[particles]
body = [{name = "a", mass = 1, x = [0, 0, 0], v = [0, 0, 0]}, {name = "b", mass = 1, x = [1, 0, 0], v = [0, 1, 0]}]
[hamiltonian]
type = "kinetic_potential"
force = [{type = "gravity"}]
[integrator]
method = "dop853"
steps = 10
[[stop]]
type = "escape"
distance = 10
steps = 1
)";

/// The keys that the reader of a table says it expects, when it is given one that nobody knows.
std::vector<std::string> keys_read(const std::string& text, const std::string& table) {
  try {
    read_scene(text, "scene.toml", standard_parts(), {table + ".qqqqwwwwqqqq=1"});
  } catch (const Error& error) {
    std::string list = error.what();
    const std::string mark = "expected one of: ";
    const std::size_t at = list.find(mark);
    INFO(list);
    REQUIRE(list.find("unknown key 'qqqqwwwwqqqq'") != std::string::npos);  // everything before it can be read
    REQUIRE(at != std::string::npos);
    list = list.substr(at + mark.size());
    std::replace(list.begin(), list.end(), ',', ' ');
    return words_of(list);
  }
  FAIL("a key that nobody knows was taken in " << table);
  return {};
}

TEST_CASE("every key that a table takes has a path", "[proposals]") {
  const Parts parts = standard_parts();
  for (const auto& [text, table] :
       {std::pair{orbit, "integrator"}, std::pair{orbit, "hamiltonian"}, std::pair{orbit, "hamiltonian.force.gravity"},
        std::pair{orbit, "stop.escape"}, std::pair{liquid, "integrator"}, std::pair{liquid, "hamiltonian.neighbors"},
        std::pair{liquid, "minimize"}, std::pair{liquid, "hamiltonian.force.lennard_jones"}}) {
    std::vector<std::string> paths = key_paths(parse_toml(text, "scene.toml"), parts);
    const std::vector<std::string> keys = keys_read(text, table);
    CHECK_FALSE(keys.empty());
    for (const std::string& key : keys) {
      const std::string path = std::string(table) + "." + key;
      INFO(path);
      // One that is written and holds tables has the paths of its keys.
      const auto is_it = [&](const std::string& one) { return one == path || one.starts_with(path + "."); };
      CHECK(std::any_of(paths.begin(), paths.end(), is_it));
    }
  }
}

}  // namespace
}  // namespace noether::test

/// docs/keys.md and `noether describe --all`: the page is what the program prints, and its keys are those of scenes.

#include "scene/scene.hpp"
#include "tests/cli/support.hpp"

#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <string_view>

namespace noether::test {
namespace {

const std::filesystem::path root = NOETHER_SOURCE_DIR;

/// The keys below a heading of the page, up to the next heading.
std::set<std::string> keys_below(const std::string& page, const std::string& heading) {
  const std::string head = "\n" + heading + "\n";
  const std::size_t begin = page.find(head);
  INFO(heading);
  REQUIRE(begin != std::string::npos);
  const std::size_t end = page.find("\n#", begin + head.size());
  const std::string part = page.substr(begin, end == std::string::npos ? end : end - begin);
  const std::regex row(R"(\n\| `(\w+)` \|)");
  std::set<std::string> keys;
  for (std::sregex_iterator at(part.begin(), part.end(), row), last; at != last; ++at) keys.insert((*at)[1].str());
  return keys;
}

/// What the reader says of a scene, be it a warning of its verdicts; empty if it reads it.
std::string refusal_of(const std::string& scene) {
  try {
    const Scene read = read_scene(scene, root / "scene.toml");
    return read.wrong_verdicts.empty() ? "" : read.wrong_verdicts.front().message();
  } catch (const Error& error) {
    return error.message();
  }
}

/// A scene with one more key in one of its tables, which no key accepts: a table with an unlikely name in it.
struct Host {
  std::string heading, before, after;  ///< of the page; the scene before and behind the key
};

const std::string attracted = "[particles]\nbody = [{name='A', mass=1}, {name='B', mass=1, x=[1,0,0], v=[0,1,0]}]\n";
const std::string gravity = "[hamiltonian]\ntype='kinetic_potential'\n[[hamiltonian.force]]\ntype='gravity'\n";
const std::string reduced = "units = 'reduced'\n";
const std::string verlet = "[integrator]\nmethod='verlet'\nstep=0.01\nsteps=10\n";
const std::string whole_scene = reduced + attracted + gravity + verlet;

const std::vector<Host> hosts = {
    {"## Above all tables", "", "\n" + whole_scene},
    {"## `[particles]`", reduced + "[particles]\n", "\n" + gravity + verlet},
    {"## `[[particles.body]]`", reduced + "[[particles.body]]\n", "\n" + gravity + verlet},
    {"## `[[particles.rigid_body]]`", reduced + "[[particles.rigid_body]]\n", "\n" + gravity + verlet},
    {"## `[[particles.rigid_body.site]]`", reduced + "[[particles.rigid_body]]\n[[particles.rigid_body.site]]\n",
     "\n" + gravity + verlet},
    {"## `[[particles.type]]`", reduced + attracted + "[[particles.type]]\n", "\n" + gravity + verlet},
    {"## `[[particles.pair]]`", reduced + attracted + "[[particles.type]]\nname='X'\n[[particles.pair]]\n",
     "\n" + gravity + verlet},
    {"## `[hamiltonian]`", reduced + attracted + "[hamiltonian]\ntype='kinetic_potential'\n", "\n" + verlet},
    {"## `[[hamiltonian.force]]`", whole_scene + "[[hamiltonian.force]]\ntype='uniform_field'\n", ""},
    {"## `[[hamiltonian.constraint]]`", whole_scene + "[[hamiltonian.constraint]]\ntype='distance'\n", ""},
    {"## `[hamiltonian.neighbors]`", whole_scene + "[hamiltonian.neighbors]\n", ""},
    {"## `[minimize]`", whole_scene + "[minimize]\n", ""},
    {"## `[integrator]`", reduced + attracted + gravity + "[integrator]\n", ""},
    {"## `[[every]]`", whole_scene + "[[every]]\ntype='checkpoint'\n", ""},
    {"## `[[stop]]`", whole_scene + "[[stop]]\ntype='escape'\n", ""},
    {"## `[[verdict]]`", whole_scene + "[[verdict]]\n", ""},
};

}  // namespace

TEST_CASE("docs/keys.md is what the program prints", "[cli][describe][docs]") {
  const ScratchFolder folder;
  const std::string page = output(folder, "describe --all");
  const bool same = read_text(root / "docs" / "keys.md") == page;
  INFO("write it again: ./noether describe --all > docs/keys.md");
  CHECK(same);
}

TEST_CASE("describe --all has every part with every key, for readers and for programs", "[cli][describe][docs]") {
  const ScratchFolder folder;
  const std::string page = output(folder, "describe --all"), json = output(folder, "describe --all --json");
  REQUIRE(is_json_line(json));
  CHECK(json_member(json, "schema") == "\"noether.keys/1\"");
  const Parts parts = standard_parts();
  const auto has_part = [&](const PartInfo& info) {
    std::set<std::string> own;
    for (const FieldInfo& field : info.fields) own.insert(field.name);
    const std::set<std::string> shown = keys_below(page, "### `" + info.name + "`");
    CAPTURE(info.name);
    for (const std::string& key : own) CHECK(shown.count(key) == 1);
    CHECK(json.find("\"name\":\"" + info.name + "\"") != std::string::npos);
  };
  for (const auto& kind : parts.hamiltonians()) has_part(kind.info);
  for (const auto& kind : parts.forces()) has_part(kind.info);
  for (const auto& kind : parts.thermostats()) has_part(kind.info);
  for (const auto& kind : parts.constraints()) has_part(kind.info);
  for (const auto& kind : parts.systems()) has_part(kind.info);
  for (const auto& kind : parts.monitors()) has_part(kind.info);
  for (const auto& kind : parts.stops()) has_part(kind.info);
  for (const MethodInfo* method : parts.methods()) CHECK(page.find(std::string(method->name)) != std::string::npos);
  CHECK(keys_below(page, "### `harmonic_bond`").count("chain") == 1);
  CHECK(noether(folder, "describe").exit_code == 2);
  CHECK(noether(folder, "describe gravity --all").exit_code == 2);
}

TEST_CASE("scenes know every key that docs/keys.md lists for a table", "[cli][describe][docs]") {
  const std::string page = read_text(root / "docs" / "keys.md");
  for (const Host& host : hosts) {
    CAPTURE(host.heading);
    const std::string unknown = refusal_of(host.before + "no_such_key = {}\n" + host.after);
    INFO(unknown);
    CHECK(unknown.find("no_such_key") != std::string::npos);
    const std::set<std::string> keys = keys_below(page, host.heading);
    CHECK(keys.size() > 1);
    for (const std::string& key : keys) {
      const std::string message = refusal_of(host.before + key + " = {}\n" + host.after);
      CAPTURE(key, message);
      CHECK(message.find("unknown key '" + key + "'") == std::string::npos);
    }
  }
}

TEST_CASE("docs/keys.md lists every key that the readers of scenes name", "[cli][describe][docs]") {
  const std::string page = read_text(root / "docs" / "keys.md");
  const std::regex list(R"((?:expect_only\(\{|\w+ \w+\* key : \{)([^}]*)\})"), word(R"re("([a-zA-Z]\w*)")re");
  int found = 0;
  for (const char* file : {"body_tables.cpp", "load.cpp", "particle_keys.cpp", "read_integrator.cpp",
                           "read_particles.cpp", "read_rigid_body.cpp", "read_structure.cpp", "read_verdicts.cpp"}) {
    const std::string text = read_text(root / "scene" / file);
    for (std::sregex_iterator at(text.begin(), text.end(), list), end; at != end; ++at) {
      const std::string names = (*at)[1].str();
      for (std::sregex_iterator one(names.begin(), names.end(), word); one != end; ++one, ++found) {
        const std::string key = (*one)[1].str();
        CAPTURE(file, key);
        const bool listed = page.find("\n| `" + key + "` |") != std::string::npos ||
                            page.find("[" + key + "]") != std::string::npos ||
                            page.find("." + key + "]") != std::string::npos;
        CHECK(listed);
      }
    }
  }
  CHECK(found > 60);
}

}  // namespace noether::test

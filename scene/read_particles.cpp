#include "scene/read_particles.hpp"

#include "engine/orbital_elements.hpp"
#include "engine/suggest.hpp"
#include "engine/text.hpp"
#include "io/bodies.hpp"
#include "io/digest.hpp"
#include "io/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace noether {

namespace {

double gravitation(const TableReader& reader) {
  const SceneContext& context = reader.context();
  return context.G ? reader.number(*context.G, "G", "length^3/mass/time^2") : context.units->G;
}

void check_mass(TableReader& reader, const std::string& name, double mass) {
  if (mass >= 0) return;
  reader.fail("mass", fmt::format("the mass of '{}' is {}; 0 (a tracer) or more is expected", name,
                                  to_text(*reader.find("mass"))));
}

constexpr std::array<std::string_view, 6> element_keys = {"a", "e", "inc", "Omega", "omega", "M"};
constexpr std::array<std::string_view, 6> element_dimensions = {"length", "1", "angle", "angle", "angle", "angle"};

/// Position and velocity from the elements of one `[[particles.body]]`, about the first body.
std::pair<Vec3<double>, Vec3<double>> from_elements(TableReader& body, const ParticleSystem<double>& s, double mass) {
  std::array<double, 6> numbers{};
  for (std::size_t k = 0; k < 6; ++k) numbers[k] = body.quantity(element_keys[k], element_dimensions[k]).value_or(0);
  if (s.size() == 0) {
    body.fail(
        "a", "the first body has no other to move about; give its x and v, or nothing to put it at rest in the origin");
  }
  if (!body.has("a"))
    body.fail(nullptr, "a", fmt::format("the elements of {} have no semi-major axis; give a", body.what()));
  const double mu = gravitation(body) * (s.masses()[0] + mass);
  try {
    auto state =
        state_from_elements<double>({numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5]}, mu);
    state.first += s.positions()[0];
    state.second += s.velocities()[0];
    return state;
  } catch (const Error& error) {
    body.refuse(error);
  }
}

Vec3<double> column(const std::array<double, 3>& v) { return Vec3<double>(v[0], v[1], v[2]); }

void add_body(TableReader& body, ParticleSystem<double>& s, std::unordered_set<std::string>& names) {
  body.expect_only({"name", "mass", "x", "v", "a", "e", "inc", "Omega", "omega", "M"});
  const std::string name = body.text("name", fmt::format("body_{}", s.size() + 1));
  if (const std::string wrong = wrong_name(name); !wrong.empty()) body.fail("name", wrong);
  const auto mass = body.quantity("mass", "mass");
  if (!mass) body.fail(nullptr, "mass", fmt::format("{} has no mass; 0 marks a tracer", body.what()));
  check_mass(body, name, *mass);
  if (!names.insert(name).second) {
    body.fail("name", fmt::format("two bodies are named '{}'; names must differ", name));
  }
  const auto x = body.vector("x", "length"), v = body.vector("v", "velocity");
  bool elements = false;
  for (const std::string_view key : element_keys) elements = body.has(key) || elements;
  if (elements && (x || v)) {
    body.fail(x ? "x" : "v",
              fmt::format("{} has both elements and {}; give one or the other", body.what(), x ? "x" : "v"));
  }
  if (elements) {
    const auto [position, velocity] = from_elements(body, s, *mass);
    s.add(name, *mass, position, velocity);
  } else if (!x != !v || (!x && s.size() > 0)) {
    body.fail(nullptr, x ? "v" : "x",
              fmt::format("{} has no {}; give x and v, or elements about the first body", body.what(), x ? "v" : "x"));
  } else {
    s.add(name, *mass, column(x.value_or(std::array<double, 3>{})), column(v.value_or(std::array<double, 3>{})));
  }
}

/// Reads a table of bodies; if there is none to be read, the scene's line that asks for it is told too.
ParticleSystem<double> bodies_in(const std::filesystem::path& file, const io::BodiesOptions& options,
                                 const TableReader& reader) {
  try {
    return io::read_bodies(file, options);
  } catch (const FileError& error) {
    const int line = reader.line("bodies");
    if (line <= 0) throw;
    throw FileError(
        error.what(),
        {.file = reader.context().source.file, .line = line, .key = reader.path_of("bodies"), .value = file.string()});
  }
}

ParticleSystem<double> from_file(TableReader& reader, const std::filesystem::path& folder, SceneValue& effective) {
  const std::string name = reader.text("bodies");
  if (name.empty()) reader.fail("bodies", "bodies = \"\" names no file; give one, such as \"bodies.csv\"");
  std::filesystem::path file = folder / name;
  std::error_code none;
  if (std::filesystem::equivalent(file, reader.context().source.file, none)) {
    reader.fail("bodies", fmt::format("bodies = \"{}\" is this scene itself; give a table of bodies, such as "
                                      "\"bodies.csv\"",
                                      name));
  }
  io::BodiesOptions options;
  options.units = reader.context().units;
  if (reader.context().G) options.G = gravitation(reader);
  ParticleSystem<double> s = bodies_in(file, options, reader);
  const std::string hash = io::sha256(io::read_bytes(file));
  const std::string expected = reader.text("bodies_sha256", hash);
  if (expected != hash) {
    reader.fail("bodies_sha256",
                fmt::format("'{}' is no longer the file this scene was run with: its hash is {}; take the "
                            "key out to use the new one",
                            name, hash));
  }
  effective.put("bodies", SceneValue::of(name, reader.line("bodies")));
  effective.put("bodies_sha256", SceneValue::of(hash, reader.line("bodies")));
  return s;
}

ParticleSystem<double> from_tables(TableReader& reader, const std::vector<const SceneValue*>& bodies,
                                   SceneValue& effective) {
  ParticleSystem<double> s(*reader.context().units);
  std::unordered_set<std::string> names;
  SceneValue::Array list;
  for (const SceneValue* table : bodies) {
    const SceneValue* name = table->find("name");
    const std::string* text = name != nullptr ? name->get<std::string>() : nullptr;
    const std::string called = text != nullptr ? *text : fmt::format("body_{}", s.size() + 1);
    TableReader body(reader.context(), *table, fmt::format("body '{}'", called),
                     fmt::format("particles.body.{}", list.size()));
    add_body(body, s, names);
    SceneValue entry = *table;
    if (name == nullptr) entry.put("name", SceneValue::of(called));
    list.push_back(std::move(entry));
  }
  effective.put("body", SceneValue::of(std::move(list)));
  return s;
}

/// For each particle its place in the order of x, y, z: equal positions become neighbors.
std::vector<Index> sorted_by_position(const ParticleSystem<double>& s) {
  std::vector<Index> order(static_cast<std::size_t>(s.size()));
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<Index>(k);
  std::stable_sort(order.begin(), order.end(), [&](Index i, Index j) {
    const Vec3<double> a = s.positions()[i], b = s.positions()[j];
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  });
  return order;
}

}  // namespace

std::optional<std::pair<Index, Index>> coincident_bodies(const ParticleSystem<double>& s) {
  const std::vector<Index> order = sorted_by_position(s);
  for (std::size_t k = 1; k < order.size(); ++k) {
    const Index i = order[k - 1], j = order[k];
    const bool massive = s.masses()[i] != 0 || s.masses()[j] != 0;
    if (massive && s.positions()[i] == s.positions()[j]) return std::pair(std::min(i, j), std::max(i, j));
  }
  return {};
}

ParticleSystem<double> read_particles(const SceneContext& context, const SceneValue& table,
                                      const std::filesystem::path& folder, SceneValue& effective) {
  TableReader reader(context, table, "[particles]", "particles");
  reader.expect_only({"bodies", "bodies_sha256", "body", "frame"});
  const bool file = reader.has("bodies");
  const auto bodies = tables_of(reader, "body");
  if (file && !bodies.empty()) {
    reader.fail("bodies", "bodies come from a file and from [[particles.body]]; give one or the other");
  }
  if (!file && bodies.empty()) {
    reader.fail(nullptr, "bodies", "there are no particles; give bodies = \"FILE.csv\", or [[particles.body]] tables");
  }
  ParticleSystem<double> s = file ? from_file(reader, folder, effective) : from_tables(reader, bodies, effective);
  const std::string frame = reader.text("frame", "as_given");
  if (frame != "as_given" && frame != "barycenter") {
    reader.fail("frame", fmt::format("unknown frame '{}'{}", frame, did_you_mean(frame, {"barycenter", "as_given"})));
  }
  if (frame == "barycenter") {
    try {
      move_to_barycenter(s);
    } catch (const Error& error) {
      reader.fail("frame", error.message());
    }
  }
  effective.put("frame", SceneValue::of(frame, reader.line("frame")));
  return s;
}

}  // namespace noether

#include "scene/read_particles.hpp"

#include "engine/charge.hpp"
#include "engine/orbital_elements.hpp"
#include "io/bodies.hpp"
#include "numbers/suggest.hpp"
#include "numbers/text.hpp"
#include "scene/particle_keys.hpp"
#include "scene/read_builder.hpp"
#include "scene/read_structure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
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

/// Types and charges of the bodies of `[[particles.body]]`.
class TypedBodies {
 public:
  TypedBodies(TableReader& reader, SceneValue& effective)
      : types_(read_types(reader, effective)), pairs_(read_pairs(reader, effective)) {
    const auto mixing = read_mixing(reader, effective);
    if (types_.empty() && (mixing || !pairs_.empty())) {
      const char* key = mixing ? "mixing" : "pair";
      reader.fail(key, fmt::format("{} is of types, and there are none; give [[particles.type]] tables", key));
    }
    topology_.mixing = mixing.value_or(Mixing::lorentz_berthelot);
    for (const TypeParameters& type : types_) topology_.type_names.push_back(type.type);
  }

  /// Takes type and charge of one body; returns the mass of its type.
  std::optional<double> add(TableReader& body) {
    std::optional<double> charge = body.quantity("charge", "charge");
    std::optional<double> mass;
    if (!types_.empty()) {
      const TypeParameters& type = types_[static_cast<std::size_t>(type_of(body))];
      if (!charge) charge = type.charge;
      mass = type.mass;
    } else if (body.has("type")) {
      body.fail("type", fmt::format("{} has a type, and there are none; give [[particles.type]] tables", body.what()));
    }
    charges_.push_back(charge);
    return mass;
  }

  void give_to(ParticleSystem<double>& s, TableReader& reader) {
    if (std::any_of(charges_.begin(), charges_.end(), [](const auto& charge) { return charge.has_value(); })) {
      auto& column = s.add_column<Charge>();
      for (std::size_t i = 0; i < charges_.size(); ++i) column[static_cast<Index>(i)] = charges_[i].value_or(0);
    }
    if (types_.empty()) return;
    std::vector<TypeParameters> rest = types_;
    for (TypeParameters& type : rest) type.charge.reset();
    try {
      // Checks masses as well; those that bodies give themselves are put back.
      const ScalarColumn<double> masses = s.masses();
      set_type_parameters(s, topology_, rest, pairs_);
      s.masses() = masses;
    } catch (const Error& error) {
      refuse_particle_key(reader, error);
    }
    s.set_topology(std::make_shared<const Topology>(std::move(topology_)));
  }

 private:
  int type_of(TableReader& body) {
    const SceneValue* value = body.find("type");
    if (value == nullptr && types_.size() > 1) {
      body.fail(nullptr, "type", fmt::format("{} has no type, and there are {}; give one", body.what(), types_.size()));
    }
    const std::string name = value == nullptr ? types_[0].type : body.text("type");
    try {
      const int type = type_of_name(topology_, name);
      topology_.types.push_back(type);
      return type;
    } catch (const Error& error) {
      body.fail("type", error.message());
    }
  }

  std::vector<TypeParameters> types_;
  std::vector<PairParameters> pairs_;
  std::vector<std::optional<double>> charges_;
  Topology topology_;
};

void add_body(TableReader& body, ParticleSystem<double>& s, std::unordered_set<std::string>& names,
              TypedBodies& typed) {
  const std::vector<ColumnInfo>& columns = body.context().columns;
  body.expect_only({"name", "mass", "x", "v", "a", "e", "inc", "Omega", "omega", "M", "type", "charge"}, columns);
  const std::string name = body.text("name", fmt::format("body_{}", s.size() + 1));
  if (const std::string wrong = wrong_name(name); !wrong.empty()) body.fail("name", wrong);
  const std::optional<double> of_type = typed.add(body);
  const auto given = body.quantity("mass", "mass"), mass = given ? given : of_type;
  if (!mass) body.fail(nullptr, "mass", fmt::format("{} has no mass; 0 marks a tracer", body.what()));
  if (given) check_mass(body, name, *mass);
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
  for (const ColumnInfo& declared : columns) {
    if (const auto row = body.row(declared)) s.set_row(declared.name, s.size() - 1, *row);
  }
}

ParticleSystem<double> from_file(TableReader& reader, const std::filesystem::path& folder, SceneValue& effective) {
  reader.expect_only({"bodies", "bodies_sha256", "frame", "box", "exclusions"});
  io::BodiesOptions options;
  options.units = reader.context().units;
  if (reader.context().G) options.G = gravitation(reader);
  return particles_in_file(reader, "bodies", folder, "bodies.csv", "a table of bodies", effective,
                           [&](const std::filesystem::path& file) { return io::read_bodies(file, options); });
}

ParticleSystem<double> from_tables(TableReader& reader, const std::vector<const SceneValue*>& bodies,
                                   SceneValue& effective) {
  reader.expect_only({"body", "frame", "box", "type", "pair", "mixing", "exclusions"});
  ParticleSystem<double> s(*reader.context().units);
  for (const ColumnInfo& column : reader.context().columns) s.add_column(column);
  TypedBodies typed(reader, effective);
  std::unordered_set<std::string> names;
  SceneValue::Array list;
  for (const SceneValue* table : bodies) {
    const SceneValue* name = table->find("name");
    const std::string* text = name != nullptr ? name->get<std::string>() : nullptr;
    const std::string called = text != nullptr ? *text : fmt::format("body_{}", s.size() + 1);
    TableReader body(reader.context(), *table, fmt::format("body '{}'", called),
                     fmt::format("particles.body.{}", list.size()));
    add_body(body, s, names, typed);
    SceneValue entry = *table;
    if (name == nullptr) entry.put("name", SceneValue::of(called));
    list.push_back(std::move(entry));
  }
  effective.put("body", SceneValue::of(std::move(list)));
  typed.give_to(s, reader);
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

/// Whether `type` names a builder; it is a list of tables where types of particles are given.
bool is_built(TableReader& reader) {
  const SceneValue* type = reader.find("type");
  return type != nullptr && type->get<SceneValue::Array>() == nullptr;
}

/// Particles come from one place. @throws SceneError
void check_sources(TableReader& reader) {
  const auto bodies = tables_of(reader, "body");
  std::vector<std::pair<const char*, const char*>> found;
  if (reader.has("bodies")) found.emplace_back("bodies", "from a file");
  if (reader.has("structure")) found.emplace_back("structure", "from a structure");
  if (is_built(reader)) found.emplace_back("type", "from a builder");
  if (!bodies.empty()) found.emplace_back("body", "from [[particles.body]]");
  if (found.size() > 1) {
    reader.fail(found[0].first,
                fmt::format("bodies come {} and {}; give one or the other", found[0].second, found[1].second));
  }
  if (found.empty()) {
    reader.fail(nullptr, "bodies",
                "there are no particles; give bodies = \"FILE.csv\", structure = \"FILE.data\", type = \"lattice\" or "
                "another builder, or [[particles.body]] tables");
  }
}

void read_frame(TableReader& reader, ParticleSystem<double>& s, SceneValue& effective) {
  if (reader.has("structure") && has_frame_number(reader)) {
    effective.put("frame", *reader.find("frame"));
    return;
  }
  const std::string frame = reader.text("frame", "as_given");
  if (frame != "as_given" && frame != "barycenter") {
    reader.fail("frame", fmt::format("unknown frame '{}'{}", frame, did_you_mean(frame, {"barycenter", "as_given"})));
  }
  if (frame == "barycenter" && s.box().is_periodic()) {
    reader.fail("frame", "a periodic box has no centre of mass; take frame = \"barycenter\" out");
  }
  if (frame == "barycenter") {
    try {
      move_to_barycenter(s);
    } catch (const Error& error) {
      reader.fail("frame", error.message());
    }
  }
  effective.put("frame", SceneValue::of(frame, reader.line("frame")));
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
                                      const std::filesystem::path& folder, SceneValue& effective,
                                      std::vector<std::string>& notes) {
  TableReader reader(context, table, "[particles]", "particles");
  if (!is_built(reader)) {
    reader.expect_only({"bodies", "bodies_sha256", "body", "structure", "structure_sha256", "type", "pair", "mixing",
                        "box", "special", "exclusions", "file_units", "atom_style", "frame", "temperature", "seed",
                        "coefficients", "coefficients_sha256"});
  }
  check_sources(reader);
  if (is_built(reader)) {
    ParticleSystem<double> s = build_particles(reader, effective);
    for (const ColumnInfo& column : context.columns) s.add_column(column);
    return s;
  }
  TableReader own(context, table, "[particles]", "particles");
  ParticleSystem<double> s = reader.has("structure") ? read_structure_particles(own, folder, effective, notes)
                             : reader.has("bodies")  ? from_file(own, folder, effective)
                                                     : from_tables(own, tables_of(own, "body"), effective);
  if (!reader.has("structure")) {
    if (const auto box = read_box(own, effective)) s.set_box(*box);
  }
  for (const ColumnInfo& column : context.columns) s.add_column(column);
  read_exclusions(own, s, effective);
  read_frame(own, s, effective);
  return s;
}

}  // namespace noether

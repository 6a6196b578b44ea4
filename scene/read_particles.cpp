#include "scene/read_particles.hpp"

#include "engine/charge.hpp"
#include "engine/given_orbit.hpp"
#include "io/bodies.hpp"
#include "io/frame_particles.hpp"
#include "numbers/quantity.hpp"
#include "numbers/suggest.hpp"
#include "numbers/text.hpp"
#include "scene/particle_keys.hpp"
#include "scene/read_builder.hpp"
#include "scene/read_structure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <unordered_map>

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

Vec3<double> column(const std::array<double, 3>& v) { return Vec3<double>(v[0], v[1], v[2]); }

/// A Julian day and, where it says one, its scale of time: "JD 2451545 TDB"; empty for what is none.
std::optional<io::BodyEpoch> julian_day_of(const SceneValue& value) {
  const std::string* text = value.get<std::string>();
  if (text == nullptr || !text->starts_with("JD ")) return {};
  io::BodyEpoch epoch;
  const char *first = text->data() + 3, *last = text->data() + text->size();
  const auto [end, problem] = std::from_chars(first, last, epoch.julian_day);
  if (problem != std::errc() || !std::isfinite(epoch.julian_day) || (end != last && *end != ' ')) return {};
  if (end != last) epoch.scale.assign(end + 1, last);
  return epoch;
}

/// `epoch = "JD 2451545 TDB"`, or without the scale. @throws SceneError
std::optional<io::BodyEpoch> read_epoch(TableReader& reader) {
  const SceneValue* value = reader.find("epoch");
  if (value == nullptr) return {};
  if (const auto epoch = julian_day_of(*value)) return epoch;
  reader.fail("epoch", fmt::format("epoch = {} is not a Julian day; one is expected, such as \"JD 2451545\" or \"JD "
                                   "2451545 TDB\"",
                                   to_text(*value)));
}

std::string text_of(const io::BodyEpoch& epoch) {
  return fmt::format("JD {}{}{}", format_number(epoch.julian_day), epoch.scale.empty() ? "" : " ", epoch.scale);
}

/// Whether a text is a number of days, however it spells them: "3 day", "3d", "3 days ".
bool is_in_days(std::string_view text, const UnitSystem& units) {
  if (units.is_reduced()) return false;
  const std::size_t begin = text.find_first_not_of(" \t+");
  if (begin == std::string_view::npos) return false;
  double number = 0;
  const char* const last = text.data() + text.size();
  const auto [end, problem] = std::from_chars(text.data() + begin, last, number);
  if (problem != std::errc() || end == last) return false;
  const double one = unit_value("1 " + std::string(end, last), units), day = unit_value("day", units);
  return std::abs(one - day) <= 1e-12 * day;
}

/// T of a body: a time from the start, or a Julian day beside the epoch of the start [time]. @throws SceneError
std::optional<double> time_of_pericenter(TableReader& body, const std::optional<io::BodyEpoch>& epoch) {
  const SceneValue* value = body.find("T");
  const auto day = value != nullptr ? julian_day_of(*value) : std::nullopt;
  if (!day) {
    const auto T = body.quantity("T", "time");
    const std::string* text = value != nullptr ? value->get<std::string>() : nullptr;
    const bool in_days = text != nullptr && is_in_days(*text, *body.context().units);
    if (in_days && io::looks_like_julian_day(*T / unit_value("day", *body.context().units))) {
      body.fail("T", fmt::format("T = {0} is counted from the start, but looks like a Julian day; give T = \"JD ...\" "
                                 "and the epoch in [particles], or give the time in yr if it is a time",
                                 to_text(*value)));
    }
    return T;
  }
  const UnitSystem& units = *body.context().units;
  if (units.is_reduced())
    body.fail("T", fmt::format("T = {} is a Julian day; the reduced system has none", to_text(*value)));
  if (!epoch) {
    body.fail("T",
              fmt::format("T = {} is a Julian day, but the epoch of the start is not given; give epoch = \"JD ...\" in "
                          "[particles]",
                          to_text(*value)));
  }
  if (!day->scale.empty() && !epoch->scale.empty() && day->scale != epoch->scale) {
    body.fail("T", fmt::format("T = {} is not in the time scale of the epoch, {}", to_text(*value), epoch->scale));
  }
  const double days = day->julian_day - epoch->julian_day;
  if (io::is_modified_beside(days)) {
    body.fail("T",
              fmt::format("T = {} is {:.9g} days from the epoch, {}: one of them looks like a modified Julian day; "
                          "add 2400000.5 to it",
                          to_text(*value), std::abs(days), text_of(*epoch)));
  }
  return days * unit_value("day", units);
}

/// Types and charges of the bodies of `[[particles.body]]`.
class TypedBodies {
 public:
  /// @param before  bodies that are there already, without types and charges
  TypedBodies(TableReader& reader, SceneValue& effective, Index before)
      : types_(read_types(reader, effective)),
        pairs_(read_pairs(reader, effective)),
        charges_(static_cast<std::size_t>(before)) {
    const auto mixing = read_mixing(reader, effective);
    if (types_.empty() && (mixing || !pairs_.empty())) {
      const char* key = mixing ? "mixing" : "pair";
      reader.fail(key, fmt::format("{} needs types, but there are none; give [[particles.type]] tables", key));
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
      body.fail("type",
                fmt::format("{} has a type, but there are no types; give [[particles.type]] tables", body.what()));
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
      body.fail(nullptr, "type",
                fmt::format("{} has no type, but there are {} types; give one", body.what(), types_.size()));
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

/// The bodies of `[[particles.body]]`, behind those of a file where there is one.
class BodyTables {
 public:
  BodyTables(TableReader& reader, SceneValue& effective, ParticleSystem<double> s, io::ElementsAbout elements,
             std::optional<io::BodyEpoch> epoch)
      : reader_(reader),
        s_(std::move(s)),
        elements_(elements),
        epoch_(std::move(epoch)),
        typed_(reader, effective, s_.size()) {
    for (const ColumnInfo& column : reader.context().columns) s_.add_column(column);
    for (Index i = 0; i < s_.size(); ++i) note(i);
  }

  /// Takes one in; returns its name.
  std::string add(const SceneValue& table, std::size_t number) {
    const SceneValue* given = table.find("name");
    const std::string* text = given != nullptr ? given->get<std::string>() : nullptr;
    const std::string called = text != nullptr ? *text : fmt::format("body_{}", s_.size() + 1);
    TableReader body(reader_.context(), table, fmt::format("body '{}'", called),
                     fmt::format("particles.body.{}", number));
    add_body(body);
    return called;
  }

  ParticleSystem<double> take() {
    typed_.give_to(s_, reader_);
    return std::move(s_);
  }

 private:
  using State = std::pair<Vec3<double>, Vec3<double>>;

  void note(Index i) {
    index_.emplace(s_.name(i), i);
    before_.add(s_.masses()[i], s_.positions()[i], s_.velocities()[i]);
  }

  void add_body(TableReader& body) {
    const std::vector<ColumnInfo>& columns = body.context().columns;
    refuse_other_names(body, columns);
    body.expect_only({"name", "mass", "about", "x", "v", "a", "P", "q", "e", "inc", "Omega", "omega", "pomega", "M",
                      "f", "l", "T", "type", "charge"},
                     columns);
    const std::string name = body.text("name", fmt::format("body_{}", s_.size() + 1));
    if (const std::string wrong = wrong_name(name); !wrong.empty()) body.fail("name", wrong);
    const std::optional<double> of_type = typed_.add(body);
    const auto given = body.quantity("mass", "mass"), mass = given ? given : of_type;
    if (!mass) refuse_without_mass(body);
    if (given) check_mass(body, name, *mass);
    if (index_.count(name) != 0) {
      body.fail("name", fmt::format("two bodies are named '{}'; names must differ", name));
    }
    const State state = state_of(body, *mass);
    s_.add(name, *mass, state.first, state.second);
    note(s_.size() - 1);
    for (const ColumnInfo& declared : columns) {
      if (const auto row = body.row(declared)) s_.set_row(declared.name, s_.size() - 1, *row);
    }
  }

  /// Refuses keys by which others call elements, with what they mean here: "om" is nearest to M, and means Omega.
  static void refuse_other_names(const TableReader& body, const std::vector<ColumnInfo>& columns) {
    for (const auto& entry : *body.table().get<SceneValue::Table>()) {
      const std::string& key = entry.first;
      const OtherName other = other_name_of(key);
      const bool declared =
          std::any_of(columns.begin(), columns.end(), [&](const auto& one) { return one.name == key; });
      if (other.told.empty() || declared) continue;
      body.fail(key, fmt::format("unknown key '{}' in {}{}", key, body.what(), other.told));
    }
  }

  State state_of(TableReader& body, double mass) const {
    const auto x = body.vector("x", "length"), v = body.vector("v", "velocity");
    const auto element =
        std::find_if(orbit_keys.begin(), orbit_keys.end(), [&](const OrbitKey& key) { return body.has(key.name); });
    const std::vector<Index> about = bodies_about(body);
    if (element != orbit_keys.end() && (x || v)) {
      body.fail(x ? "x" : "v",
                fmt::format("{} has both elements and {}; give one or the other", body.what(), x ? "x" : "v"));
    }
    if (element != orbit_keys.end()) return by_elements(body, mass, about, element->name);
    if (!x != !v || (!x && s_.size() > 0)) {
      body.fail(
          nullptr, x ? "v" : "x",
          fmt::format("{} has no {}; give x and v, or elements about the first body", body.what(), x ? "v" : "x"));
    }
    State state(column(x.value_or(std::array<double, 3>{})), column(v.value_or(std::array<double, 3>{})));
    return about.empty() ? state : moved(state, center_at(body, about));
  }

  static State moved(const State& state, const OrbitCenter& center) {
    return {state.first + center.x(), state.second + center.v()};
  }

  /// Position and velocity from elements: about those that `about` names, else the first body or, of Jacobi's
  /// elements, the barycenter of all before it.
  State by_elements(TableReader& body, double mass, const std::vector<Index>& about, std::string_view first_key) const {
    GivenOrbit orbit;
    for (const OrbitKey& key : orbit_keys) {
      orbit.*key.value = key.name == "T" ? time_of_pericenter(body, epoch_) : body.quantity(key.name, key.dimension);
    }
    if (s_.size() == 0) {
      body.fail(
          first_key,
          "the first body has no other body to orbit; give its x and v, or neither to put it at rest at the origin");
    }
    if (!orbit.a && !orbit.P && !orbit.q) {
      body.fail(nullptr, "a",
                fmt::format("the elements of {} do not give a size; give the semi-major axis a, the period P or the "
                            "pericenter distance q",
                            body.what()));
    }
    const bool jacobi = about.empty() && elements_ == io::ElementsAbout::all_before_it;
    const OrbitCenter center = jacobi ? before_ : center_at(body, about.empty() ? std::vector<Index>{0} : about);
    if (!about.empty() && center.mass() + mass == 0) {
      body.fail("about",
                fmt::format("about = {} has no mass; a body with a mass is expected", to_text(*body.find("about"))));
    }
    try {
      return moved(state_of_orbit(orbit, gravitation(body) * (center.mass() + mass)), center);
    } catch (const Error& error) {
      body.refuse(error);
    }
  }

  /// The bodies that `about` names: one by a text, several by a list.
  std::vector<Index> bodies_about(TableReader& body) const {
    const SceneValue* value = body.find("about");
    if (value == nullptr) return {};
    const auto named = [&](const SceneValue& one) {
      const std::string* name = one.get<std::string>();
      if (name == nullptr) body.wrong_kind(*value, "about", "the name of a body, or a list of names,");
      const auto found = index_.find(*name);
      if (found == index_.end()) {
        body.fail("about", fmt::format("about = {}: there is no body '{}' above {}{}", to_text(*value), *name,
                                       body.what(), did_you_mean(*name, s_.names())));
      }
      return found->second;
    };
    const auto* list = value->get<SceneValue::Array>();
    if (list == nullptr) return {named(*value)};
    std::vector<Index> found;
    for (const SceneValue& one : *list) found.push_back(named(one));
    std::vector<Index> sorted = found;
    std::sort(sorted.begin(), sorted.end());
    if (found.empty() || std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
      body.fail("about",
                fmt::format("about = {} is not a valid barycenter; different bodies are expected", to_text(*value)));
    }
    return found;
  }

  OrbitCenter center_at(TableReader& body, const std::vector<Index>& about) const {
    try {
      return center_of(s_, about);
    } catch (const Error& error) {
      body.fail("about", fmt::format("about = {}: {}", to_text(*body.find("about")), error.message()));
    }
  }

  TableReader& reader_;
  ParticleSystem<double> s_;
  io::ElementsAbout elements_;
  std::optional<io::BodyEpoch> epoch_;
  TypedBodies typed_;
  std::unordered_map<std::string, Index> index_;
  OrbitCenter before_;  ///< of all bodies so far
};

/// `elements = "jacobi"`: what elements are about. @throws SceneError
io::ElementsAbout read_elements_about(TableReader& reader, SceneValue& effective) {
  const SceneValue* value = reader.find("elements");
  if (value == nullptr) return io::ElementsAbout::first_body;
  const std::string text = reader.text("elements");
  if (text != "jacobi" && text != "first_body") {
    reader.fail("elements", fmt::format("unknown elements '{}'{}", text, did_you_mean(text, {"first_body", "jacobi"})));
  }
  effective.put("elements", *value);
  return text == "jacobi" ? io::ElementsAbout::all_before_it : io::ElementsAbout::first_body;
}

/// The bodies of a table in a file, and the moment for which they hold.
ParticleSystem<double> from_file(TableReader& reader, const std::filesystem::path& folder, io::ElementsAbout elements,
                                 bool alone, std::optional<io::BodyEpoch>& epoch, SceneValue& effective,
                                 std::vector<std::string>& warnings) {
  io::BodiesOptions options{.units = reader.context().units, .elements = elements};
  if (reader.context().G) options.G = gravitation(reader);
  const std::optional<io::BodyEpoch> wanted = epoch;
  if (wanted) options.epoch = wanted->julian_day;
  io::BodyTable table;
  ParticleSystem<double> s = particles_in_file(reader, "bodies", folder, "bodies.csv", "a table of bodies", effective,
                                               [&](const std::filesystem::path& file) {
                                                 table = io::read_body_table(file, options);
                                                 return std::move(table.particles);
                                               });
  if (table.epoch) {
    if (wanted && !wanted->scale.empty() && !table.epoch->scale.empty() && wanted->scale != table.epoch->scale) {
      reader.fail("epoch", fmt::format("epoch = \"{}\" is not in the time scale of the tables, {}", text_of(*wanted),
                                       table.epoch->scale));
    }
    epoch = table.epoch;
    if (epoch->scale.empty() && wanted) epoch->scale = wanted->scale;
  }
  if (!table.light_center.empty()) warnings.push_back(table.light_center);
  if (table.without_sun && alone) {
    warnings.push_back(
        fmt::format("the states in {} are about the Solar System Barycenter, but the Sun is not among them",
                    reader.text("bodies")));
  }
  return s;
}

/// Whether the bodies are those of a frame of run.h5.
bool are_of_a_frame(TableReader& reader, const std::filesystem::path& folder) {
  return reader.has("bodies") && io::is_hdf5(folder / reader.text("bodies"));
}

/// The bodies of a frame of run.h5, the last unless `frame` says which. What the frame is stands in the effective
/// table: a run that goes on writing must not change the start of this one.
ParticleSystem<double> from_frame(TableReader& reader, const std::filesystem::path& folder, SceneValue& effective,
                                  std::vector<std::string>& warnings) {
  io::FrameOptions options{.frame = {}, .units = reader.context().units, .columns = reader.context().columns};
  if (has_frame_number(reader)) options.frame = reader.integer("frame");
  io::FrameParticles found;
  const auto read = [&](const std::filesystem::path& file) {
    try {
      found = io::read_frame_particles(file, options);
    } catch (const FileError&) {
      throw;
    } catch (const Error& error) {
      if (error.key() == "units") reader.fail("bodies", error.message());
      reader.fail(error.key(), error.message());
    }
    return std::move(found.particles);
  };
  ParticleSystem<double> s =
      particles_in_file(reader, "bodies", folder, "run.h5", "a run.h5", effective, read, [&] { return found.sha256; });
  if (has_frame_number(reader) || !reader.has("frame"))
    effective.put("frame", SceneValue::of(found.frame, reader.line("frame")));
  if (!found.knows_types) {
    warnings.push_back(
        fmt::format("{} is from a version that did not store types, molecules and bonds: its particles have none here",
                    reader.text("bodies")));
  }
  for (const std::string& name : found.left_out) {
    warnings.push_back(
        fmt::format("no part of this scene uses the column '{}' of {}: it is left out", name, reader.text("bodies")));
  }
  if (reader.has("body") && (s.topology() != nullptr || s.has<Charge>())) {
    reader.fail("body",
                fmt::format("the particles of {} have types, bonds or charges, which bodies of tables would not "
                            "have; take [[particles.body]] out",
                            reader.text("bodies")));
  }
  return s;
}

/// Bodies of a file, of `[[particles.body]]` tables, or of both, in this order.
ParticleSystem<double> from_bodies(TableReader& reader, const std::filesystem::path& folder, SceneValue& effective,
                                   std::vector<std::string>& warnings) {
  const bool file = reader.has("bodies"), frame = are_of_a_frame(reader, folder);
  if (frame && !reader.has("body")) {  // so nobody has a passage at a date
    reader.expect_only({"bodies", "bodies_sha256", "elements", "frame", "box", "exclusions"});
  } else if (frame || file) {
    reader.expect_only({"bodies", "bodies_sha256", "epoch", "elements", "body", "frame", "box", "exclusions"});
  } else {
    reader.expect_only({"body", "epoch", "elements", "frame", "box", "type", "pair", "mixing", "exclusions"});
  }
  const auto tables = tables_of(reader, "body");
  const io::ElementsAbout elements = read_elements_about(reader, effective);
  ParticleSystem<double> s(*reader.context().units);
  std::optional<io::BodyEpoch> epoch = read_epoch(reader);
  if (frame) {
    s = from_frame(reader, folder, effective, warnings);
  } else if (file) {
    s = from_file(reader, folder, elements, tables.empty(), epoch, effective, warnings);
  }
  if (epoch) effective.put("epoch", SceneValue::of(text_of(*epoch), reader.line("epoch")));
  if (tables.empty()) return s;
  BodyTables bodies(reader, effective, std::move(s), elements, epoch);
  SceneValue::Array list;
  for (const SceneValue* table : tables) {
    const std::string name = bodies.add(*table, list.size());
    SceneValue entry = *table;
    if (entry.find("name") == nullptr) entry.put("name", SceneValue::of(name));
    list.push_back(std::move(entry));
  }
  effective.put("body", SceneValue::of(std::move(list)));
  return bodies.take();
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

/// Particles come from one place; only bodies of a file and of tables may stand together. @throws SceneError
void check_sources(TableReader& reader) {
  const auto bodies = tables_of(reader, "body");
  std::vector<std::pair<const char*, const char*>> found;
  if (reader.has("bodies")) found.emplace_back("bodies", "from a file");
  if (reader.has("structure")) found.emplace_back("structure", "from a structure");
  if (is_built(reader)) found.emplace_back("type", "from a builder");
  if (!bodies.empty()) found.emplace_back("body", "from [[particles.body]]");
  const bool both = found.size() == 2 && reader.has("bodies") && !bodies.empty();
  if (found.size() > 1 && !both) {
    reader.fail(found[0].first,
                fmt::format("bodies come {} and {}; give one or the other", found[0].second, found[1].second));
  }
  if (found.empty()) {
    reader.fail(nullptr, "bodies",
                "there are no particles; give bodies = \"FILE.csv\", structure = \"FILE.data\", type = \"lattice\" or "
                "another builder, or [[particles.body]] tables");
  }
}

/// @param of_a_frame  particles of run.h5, whose frame has been read
void read_frame(TableReader& reader, ParticleSystem<double>& s, bool of_a_frame, SceneValue& effective) {
  if (reader.has("structure") && has_frame_number(reader)) {
    effective.put("frame", *reader.find("frame"));
    return;
  }
  if (of_a_frame && (has_frame_number(reader) || !reader.has("frame"))) return;
  if (has_frame_number(reader)) {
    reader.fail("frame", fmt::format("frame = {} is the number of a frame, but {} has no frames; \"barycenter\" or "
                                     "\"as_given\" is expected",
                                     to_text(*reader.find("frame")),
                                     reader.has("bodies") ? "a table of bodies" : "[[particles.body]]"));
  }
  const std::string frame = reader.text("frame", "as_given");
  if (frame != "as_given" && frame != "barycenter") {
    reader.fail("frame", no_such_frame(frame, of_a_frame || reader.has("structure")));
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

std::string epoch_of(const SceneValue& effective) {
  const SceneValue* particles = effective.find("particles");
  const SceneValue* epoch = particles != nullptr ? particles->find("epoch") : nullptr;
  return epoch != nullptr ? *epoch->get<std::string>() : "";
}

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
                                      std::vector<std::string>& warnings) {
  TableReader reader(context, table, "[particles]", "particles");
  if (!is_built(reader)) {
    reader.expect_only({"bodies",    "bodies_sha256",    "epoch",      "elements",     "body",
                        "structure", "structure_sha256", "type",       "pair",         "mixing",
                        "box",       "special",          "exclusions", "file_units",   "atom_style",
                        "frame",     "temperature",      "seed",       "coefficients", "coefficients_sha256"});
  }
  check_sources(reader);
  if (is_built(reader)) {
    ParticleSystem<double> s = build_particles(reader, effective);
    for (const ColumnInfo& column : context.columns) s.add_column(column);
    return s;
  }
  TableReader own(context, table, "[particles]", "particles");
  ParticleSystem<double> s = reader.has("structure") ? read_structure_particles(own, folder, effective, warnings)
                                                     : from_bodies(own, folder, effective, warnings);
  if (!reader.has("structure")) {
    const auto box = read_box(own, effective);
    // A box that particles of run.h5 have already would only count their images anew.
    if (box && !(*box == s.box())) s.set_box(*box);
  }
  for (const ColumnInfo& column : context.columns) s.add_column(column);
  read_exclusions(own, s, effective);
  read_frame(own, s, !reader.has("structure") && are_of_a_frame(reader, folder), effective);
  return s;
}

}  // namespace noether

#include "scene/body_tables.hpp"

#include "engine/bodies.hpp"
#include "engine/charge.hpp"
#include "engine/given_orbit.hpp"
#include "io/bodies.hpp"
#include "numbers/quantity.hpp"
#include "numbers/suggest.hpp"
#include "numbers/text.hpp"
#include "scene/foreign_names.hpp"
#include "scene/particle_keys.hpp"
#include "scene/read_rigid_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace noether {

double gravitation(const TableReader& reader) {
  const SceneContext& context = reader.context();
  return context.G ? reader.number(*context.G, "G", "length^3/mass/time^2") : context.units->G;
}

std::optional<BodyPlace> place_of_body(const SceneValue& particles, std::string_view name) {
  for (const char* key : {"body", "rigid_body"}) {
    const SceneValue* tables = particles.find(key);
    const auto* list = tables != nullptr ? tables->get<SceneValue::Array>() : nullptr;
    for (std::size_t k = 0; list != nullptr && k < list->size(); ++k) {
      const SceneValue* given = (*list)[k].find("name");
      const std::string* text = given != nullptr ? given->get<std::string>() : nullptr;
      if (text != nullptr && *text == name) return BodyPlace{key, &(*list)[k]};
    }
  }
  return {};
}

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

std::string text_of(const io::BodyEpoch& epoch) {
  return fmt::format("JD {}{}{}", format_number(epoch.julian_day), epoch.scale.empty() ? "" : " ", epoch.scale);
}

namespace {

void check_mass(TableReader& reader, const std::string& name, double mass) {
  if (mass >= 0) return;
  reader.fail("mass", fmt::format("the mass of '{}' is {}; 0 (a tracer) or more is expected", name,
                                  to_text(*reader.find("mass"))));
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
  /// @param before  bodies that are there already, without types
  TypedBodies(TableReader& reader, SceneValue& effective, const ParticleSystem<double>& before)
      : types_(read_types(reader, effective)),
        pairs_(read_pairs(reader, effective)),
        charges_(static_cast<std::size_t>(before.size())) {
    for (std::size_t i = 0; before.has<Charge>() && i < charges_.size(); ++i)
      charges_[i] = before.column<Charge>()[static_cast<Index>(i)];
    const auto mixing = read_mixing(reader, effective);
    if (types_.empty() && (mixing || !pairs_.empty())) {
      const char* key = mixing ? "mixing" : "pair";
      reader.fail(key, fmt::format("{} needs types, but there are none; give [[particles.type]] tables", key));
    }
    topology_.mixing = mixing.value_or(Mixing::lorentz_berthelot);
    for (const TypeParameters& type : types_) topology_.type_names.push_back(type.type);
  }

  /// Takes type and charge of one body; returns the mass of its type.
  /// @param of_sites  a body whose sites have types, and which has none itself
  std::optional<double> add(TableReader& body, bool of_sites) {
    std::optional<double> charge = body.quantity("charge", "charge");
    std::optional<double> mass;
    if (!types_.empty() && of_sites) {
      topology_.types.push_back(0);
    } else if (!types_.empty()) {
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

  io::SiteTypes of_sites() const {
    io::SiteTypes types{topology_.type_names};
    for (const TypeParameters& type : types_) types.charges.push_back(type.charge.value_or(0));
    return types;
  }
  /// Gives a site type and charge of the last body.
  void give_last_to(BodySite& site) const {
    site.charge = charges_.back().value_or(0);
    if (!topology_.types.empty()) site.type = static_cast<int>(topology_.types.back());
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
  BodyTables(TableReader& reader, SceneValue& effective, ParticleSystem<double> s, BodyTableOptions options,
             std::vector<std::string>& warnings)
      : reader_(reader),
        options_(std::move(options)),
        warnings_(warnings),
        s_(std::move(s)),
        bodies_(s_.bodies() != nullptr ? *s_.bodies() : Bodies{}),
        typed_(reader, effective, s_) {
    for (const ColumnInfo& column : reader.context().columns) s_.add_column(column);
    for (Index i = 0; i < s_.size(); ++i) note(i);
  }

  /// Takes in those of one key, `body` or `rigid_body`; returns them as they are kept.
  SceneValue::Array add_all(std::string_view key, const std::vector<const SceneValue*>& tables) {
    SceneValue::Array list;
    for (const SceneValue* table : tables) {
      const SceneValue* given = table->find("name");
      const std::string* text = given != nullptr ? given->get<std::string>() : nullptr;
      const std::string called = text != nullptr ? *text : fmt::format("body_{}", s_.size() + 1);
      TableReader body(reader_.context(), *table, fmt::format("body '{}'", called),
                       fmt::format("particles.{}.{}", key, list.size()));
      SceneValue kept = *table;
      if (kept.find("name") == nullptr) kept.put("name", SceneValue::of(called));
      add_body(body, key == "rigid_body" ? &kept : nullptr);
      list.push_back(std::move(kept));
    }
    return list;
  }

  ParticleSystem<double> take() {
    typed_.give_to(s_, reader_);
    if (!bodies_.kinds.empty()) s_.set_bodies(std::make_shared<const Bodies>(std::move(bodies_)));
    return std::move(s_);
  }

 private:
  using State = std::pair<Vec3<double>, Vec3<double>>;

  void note(Index i) {
    index_.emplace(s_.name(i), i);
    before_.add(s_.masses()[i], s_.positions()[i], s_.velocities()[i]);
  }

  /// @param rigid  of a rigid body, its table as it is kept; null: of a point
  void add_body(TableReader& body, SceneValue* rigid) {
    const std::vector<ColumnInfo>& columns = body.context().columns;
    refuse_other_names(body, columns);
    for (std::size_t k = 0; rigid != nullptr && k < rigid_body_keys().size(); ++k) body.find(rigid_body_keys()[k]);
    body.expect_only({"name", "mass", "about", "x", "v", "a", "P", "q", "e", "inc", "Omega", "omega", "pomega", "M",
                      "f", "l", "T", "type", "charge"},
                     columns);
    const std::string name = body.text("name", fmt::format("body_{}", s_.size() + 1));
    if (const std::string wrong = wrong_name(name); !wrong.empty()) body.fail("name", wrong);
    const bool by_sites = rigid != nullptr && (body.has("sites") || body.has("site"));
    const std::optional<double> of_type = typed_.add(body, by_sites);
    const auto given = body.quantity("mass", "mass"), mass = given ? given : of_type;
    if (!mass && !by_sites) refuse_without_mass(body);
    if (given && rigid == nullptr) check_mass(body, name, *mass);
    if (index_.count(name) != 0) {
      body.fail("name", fmt::format("two bodies are named '{}'; names must differ", name));
    }
    if (rigid != nullptr) {
      add_rigid_body(body, name, mass.value_or(0), *rigid);
    } else {
      const State state = state_of(body, *mass);
      s_.add(name, *mass, state.first, state.second);
    }
    note(s_.size() - 1);
    for (const ColumnInfo& declared : columns) {
      if (const auto row = body.row(declared)) s_.set_row(declared.name, s_.size() - 1, *row);
    }
  }

  void add_rigid_body(TableReader& body, const std::string& name, double mass, SceneValue& kept) {
    RigidBody made = read_rigid_body(body, name, mass, options_.folder, typed_.of_sites(), kept);
    if (!made.warning.empty()) warnings_.push_back(made.warning);
    if (made.sites.size() == 1) typed_.give_last_to(made.sites.front());
    BodyState turn = read_turn(body);
    if (made.held) {
      turn.x = column(*body.vector("fixed_point", "length"));
    } else {
      std::tie(turn.x, turn.v) = state_of(body, made.mass);
    }
    try {
      noether::add_body(s_, bodies_, made, turn);
    } catch (const Error& error) {
      body.refuse(error);
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
      orbit.*key.value =
          key.name == "T" ? time_of_pericenter(body, options_.epoch) : body.quantity(key.name, key.dimension);
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
    const bool jacobi = about.empty() && options_.elements == io::ElementsAbout::all_before_it;
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

  /// What is wrong where a body is in a table of the other kind than `of`; nothing where it is not.
  std::string of_the_other_kind(const std::string& name, const TableReader& of) const {
    const std::optional<BodyPlace> place = place_of_body(reader_.table(), name);
    if (!place) return {};
    const auto* list = reader_.table().find(place->key)->get<SceneValue::Array>();
    const auto is_it = [&](const SceneValue& table) { return &table == &of.table(); };
    if (std::any_of(list->begin(), list->end(), is_it)) return {};
    return fmt::format("; put a [[particles.{}]] first in the file, and all tables of that kind come first",
                       place->key);
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
        const std::string elsewhere = of_the_other_kind(*name, body);
        body.fail("about", fmt::format("about = {}: there is no body '{}' above {}{}", to_text(*value), *name,
                                       body.what(), elsewhere.empty() ? did_you_mean(*name, s_.names()) : elsewhere));
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
  BodyTableOptions options_;
  std::vector<std::string>& warnings_;
  ParticleSystem<double> s_;
  Bodies bodies_;  ///< of the particles, until they get them
  TypedBodies typed_;
  std::unordered_map<std::string, Index> index_;
  OrbitCenter before_;  ///< of all bodies so far
};

}  // namespace

ParticleSystem<double> add_body_tables(TableReader& reader, SceneValue& effective, ParticleSystem<double> s,
                                       BodyTableOptions options, std::vector<std::string>& warnings) {
  const auto points = tables_of(reader, "body"), rigid = tables_of(reader, "rigid_body");
  BodyTables bodies(reader, effective, std::move(s), std::move(options), warnings);
  const auto take = [&](const char* key, const std::vector<const SceneValue*>& tables) {
    if (!tables.empty()) effective.put(key, SceneValue::of(bodies.add_all(key, tables)));
  };
  const bool rigid_first = !points.empty() && !rigid.empty() && rigid.front()->line < points.front()->line;
  if (rigid_first) take("rigid_body", rigid);
  take("body", points);
  if (!rigid_first) take("rigid_body", rigid);
  return bodies.take();
}

}  // namespace noether

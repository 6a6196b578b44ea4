#include "scene/scene.hpp"

#include "integrators/all_schemes.hpp"
#include "io/files.hpp"
#include "io/trajectory_sites.hpp"
#include "numbers/suggest.hpp"
#include "scene/check.hpp"
#include "scene/default_watches.hpp"
#include "scene/gyration.hpp"
#include "scene/key_paths.hpp"
#include "scene/minimize.hpp"
#include "scene/part_columns.hpp"
#include "scene/read_constraints.hpp"
#include "scene/read_force.hpp"
#include "scene/read_integrator.hpp"
#include "scene/read_particles.hpp"
#include "scene/read_thermostat.hpp"
#include "scene/read_verdicts.hpp"
#include "scene/set_option.hpp"
#include "scene/toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace noether {

namespace {

/// Reads a scene, table by table.
class SceneReader {
 public:
  SceneReader(const SceneValue& root, const Parts& parts, Scene& scene) : root_(root), parts_(parts), scene_(scene) {
    context_.source = scene.source;
    context_.notes = &scene.notes;
  }

  /// @return the run that was put together to check it
  Simulation<double> read() {
    TableReader top(context_, root_, "", "");
    for (const std::string_view key : top_keys) top.find(key);
    top.finish();
    scene_.title = top.text("title");
    context_.program = top.text("program");
    read_units(top);
    scene_.effective = SceneValue::table();
    scene_.effective.put("title", SceneValue::of(scene_.title));
    scene_.effective.put("units", SceneValue::of(std::string(scene_.units->name), top.line("units")));
    if (const SceneValue* system = top.find("system")) {
      read_system(top, *system);
    } else {
      read_constant(table(top, "hamiltonian"));
      read_rate_of_frame(table(top, "hamiltonian"));
      context_.columns = declared_columns(context_, parts_, table(top, "hamiltonian"));
      context_.other_columns = columns_of_other_parts(parts_, context_.columns);
      SceneValue& particles = scene_.effective.put("particles", SceneValue::table());
      scene_.particles =
          read_particles(context_, table(top, "particles"), scene_.file.parent_path(), particles, scene_.warnings);
      read_hamiltonian(table(top, "hamiltonian"));
      context_.gravitates = scene_.hamiltonian.is_keplerian();
      // The scene in a file has a constant even so: that of the units, which binds no monitor.
      if (!context_.gravitates && scene_.hamiltonian.G == scene_.units->G) context_.G.reset();
      context_.gyration = first_gyration(scene_, start_time(table(top, "integrator")));
      if (const SceneValue* start = top.find("minimize")) {
        scene_.effective.put("minimize", read_minimize(context_, *start, scene_));
      }
    }
    scene_.integrator =
        read_integrator(context_, table(top, "integrator"), parts_, !scene_.hamiltonian.constraints.empty(),
                        scene_.effective.put("integrator", SceneValue::table()));
    if (scene_.hamiltonian.rotating) fit_rotor(table(top, "hamiltonian"));
    read_watches(top);
    read_stops(top);
    const SceneValue* expect = top.find("expect");
    if (expect != nullptr) scene_.effective.put("expect", *expect);
    scene_.verdicts = read_verdicts(context_, top, scene_.wrong_verdicts);
    if (const SceneValue* verdicts = top.find("verdict")) scene_.effective.put("verdict", *verdicts);
    Simulation<double> run = check_scene(context_, root_, scene_);
    if (!top.has("every")) add_default_watches(context_, scene_, run.claims());
    if (expect != nullptr) read_expectations(*expect);
    scene_.effective_toml = print_toml(scene_.effective);
    return run;
  }

 private:
  static const SceneValue& table(TableReader& top, std::string_view key) {
    const SceneValue* value = top.find(key);
    if (value == nullptr) top.fail(nullptr, key, fmt::format("the table [{}] is missing", key));
    return *value;
  }

  void read_units(TableReader& top) {
    if (!top.has("units"))
      top.fail(nullptr, "units", "units are missing; give units = \"solar\", \"molecular\", \"si\" or \"reduced\"");
    try {
      scene_.units = context_.units = &unit_system(top.text("units"));
    } catch (const SceneError&) {
      throw;
    } catch (const Error& error) {
      top.fail("units", error.message());
    }
  }

  void read_system(TableReader& top, const SceneValue& table) {
    for (const char* other : {"particles", "hamiltonian", "minimize"}) {
      if (!top.has(other)) continue;
      top.fail(other, fmt::format("[{}] and [system] are both given; a run has either particles and a Hamiltonian or a "
                                  "first-order system: take one out",
                                  other));
    }
    const auto [kind, type] = kind_of_part(context_, table, "system", "system", parts_.systems(), {});
    context_.start_time = start_time(SceneReader::table(top, "integrator"));
    TableReader reader(context_, table, fmt::format("system '{}'", type), "system");
    reader.find("type");
    SceneSystem system = kind->read(reader);
    SceneValue& effective = scene_.effective.put("system", SceneValue::table());
    effective.put("type", SceneValue::of(type, reader.line("type")));
    for (auto& [key, value] : *system.effective.get<SceneValue::Table>()) effective.put(key, value);
    scene_.particles = system.start;
    context_.of_system = true;
    scene_.system = std::move(system);
    refuse_scheme(SceneReader::table(top, "integrator"));
  }

  /// What the clock shows when the run begins [time]: systems may begin by it.
  double start_time(const SceneValue& integrator) const {
    TableReader reader(context_, integrator, "[integrator]", "integrator");
    return reader.quantity("start_time", "time").value_or(0);
  }

  /// What a scheme takes or not is no matter where it cannot be used at all.
  void refuse_scheme(const SceneValue& table) {
    TableReader integrator(context_, table, "[integrator]", "integrator");
    const std::string method = integrator.text("method");
    const bool letters = !method.empty() && method.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string::npos;
    if (schemes::find(method) == nullptr && !letters) return;
    integrator.fail("method", fmt::format("'{}' splits a Hamiltonian, but system '{}' has none; use a method for "
                                          "y' = f, such as 'dop853', or 'rodas_5p' where it is stiff",
                                          method, scene_.system->name));
  }

  void read_constant(const SceneValue& hamiltonian) {
    TableReader reader(context_, hamiltonian, "[hamiltonian]", "hamiltonian");
    const SceneValue* G = reader.find("G");
    if (G == nullptr) return read_constant_of_force(hamiltonian);
    scene_.hamiltonian.G = reader.number(*G, "G", "length^3/mass/time^2");
    if (!(*scene_.hamiltonian.G > 0)) {
      reader.fail(
          "G", fmt::format("G = {} is not a valid gravitational constant; a number above 0 is expected", to_text(*G)));
    }
    context_.G = *G;
  }

  /// Omega of a Hamiltonian in a turning frame, which builders and monitors want too. What is wrong with it is told
  /// when the Hamiltonian is read.
  void read_rate_of_frame(const SceneValue& hamiltonian) {
    const SceneValue *type = hamiltonian.find("type"), *Omega = hamiltonian.find("Omega");
    const std::string* name = type != nullptr ? type->get<std::string>() : nullptr;
    if (name == nullptr || Omega == nullptr) return;
    for (const auto& kind : parts_.hamiltonians()) {
      if (kind.info.name != *name) continue;
      for (const FieldInfo& field : kind.info.fields) {
        if (detail::is_rate_of_frame(field.name, field.dimension)) context_.Omega = *Omega;
      }
    }
  }

  /// G that stands in a force alone is that of the scene too: of orbits by elements, and of what watches them.
  void read_constant_of_force(const SceneValue& hamiltonian) {
    const SceneValue* forces = hamiltonian.find("force");
    const auto* list = forces != nullptr ? forces->get<SceneValue::Array>() : nullptr;
    for (std::size_t k = 0; list != nullptr && k < list->size() && !context_.G; ++k) {
      TableReader reader(context_, (*list)[k], "[[hamiltonian.force]]", fmt::format("hamiltonian.force.{}", k));
      const SceneValue* G = (*list)[k].get<SceneValue::Table>() != nullptr ? reader.find("G") : nullptr;
      if (G == nullptr) continue;
      const double value = reader.number(*G, "G", "length^3/mass/time^2");
      if (!(value > 0)) continue;  // the force will tell
      scene_.hamiltonian.G = value;
      context_.G = *G;
    }
  }

  void read_hamiltonian(const SceneValue& table) {
    SceneHamiltonian& made = scene_.hamiltonian;
    const auto [kind, type] = kind_of_part(context_, table, "hamiltonian", "hamiltonian", parts_.hamiltonians(), {});
    TableReader reader(context_, table, "[hamiltonian]", "hamiltonian");
    SceneValue& effective = scene_.effective.put("hamiltonian", SceneValue::table());
    effective.put("type", SceneValue::of(type, reader.line("type")));
    effective.put("G", context_.G ? *context_.G : SceneValue::of(scene_.units->G));
    const auto forces = tables_of(reader, "force"), fields = tables_of(reader, "field"),
               constraints = tables_of(reader, "constraint");
    const SceneValue *thermostat = reader.find("thermostat"), *neighbors = reader.find("neighbors");
    for (const char* key : {"type", "G", "force", "field", "constraint", "rotor", "axes"}) reader.find(key);
    made.splitting = kind->read(reader);
    reader.finish();
    for (const auto& [key, value] : *made.splitting.effective.get<SceneValue::Table>()) {
      if (key != "G") effective.put(key, value).line = reader.line(key);
    }
    read_rotor(reader, effective);
    check_splitting(reader, constraints);
    if (kind->needs_forces && forces.empty() && fields.empty() && constraints.empty() &&
        !has_bodies(scene_.particles)) {
      reader.fail("type", fmt::format("{} has no force, so nothing would move anything; add a [[hamiltonian.force]] "
                                      "table",
                                      type));
    }
    // Before the forces: what is held is no longer for the force 'bonded'.
    SceneValue::Array list, listed_fields, held;
    if (!constraints.empty()) held = read_constraints(context_, constraints, parts_, scene_);
    for (const SceneValue* force : forces) read_force(*force, "force", list);
    for (const SceneValue* field : fields) read_force(*field, "field", listed_fields);
    if (!list.empty()) effective.put("force", SceneValue::of(std::move(list)));
    if (!listed_fields.empty()) effective.put("field", SceneValue::of(std::move(listed_fields)));
    if (thermostat != nullptr) effective.put("thermostat", read_thermostat(context_, *thermostat, parts_, scene_));
    if (neighbors != nullptr) effective.put("neighbors", read_neighbors(*neighbors));
    if (!held.empty()) effective.put("constraint", SceneValue::of(std::move(held)));
  }

  /// `rotor` and `axes`: how rigid bodies turn.
  void read_rotor(TableReader& reader, SceneValue& effective) {
    SceneHamiltonian& made = scene_.hamiltonian;
    if (!has_bodies(scene_.particles)) {
      for (const char* key : {"rotor", "axes"}) {
        if (!reader.has(key)) continue;
        reader.fail(key, fmt::format("{} is said of rigid bodies, but there are none; take it out", key));
      }
      return;
    }
    if (!made.splitting.claims().twists) {
      reader.fail("type", fmt::format("{} moves points, but some particles are rigid bodies; use {}",
                                      made.splitting.name, plain_hamiltonian()));
    }
    RotatingOptions options;
    read_fields(reader, options);
    detail::check_fields(reader, options);
    if (reader.has("axes") && options.rotor != Rotor::axes) {
      reader.fail("axes", "axes are those of rotor = \"axes\"; give that, or take axes out");
    }
    put_fields(reader, options, effective);
    if (options.rotor != Rotor::axes) effective.erase("axes");
    made.rotating = options;
  }

  /// A method may turn bodies in a way of its own, which the scene then need not say.
  void fit_rotor(const SceneValue& hamiltonian) {
    const TableReader reader(context_, hamiltonian, "[hamiltonian]", "hamiltonian");
    const SceneIntegrator& made = scene_.integrator;
    const std::optional<Rotor> own = rotor_of(made.classical ? "" : made.scheme.rotor);
    if (!made.on_groups() && !own) return;
    if (hamiltonian.find("rotor") == nullptr) {
      scene_.effective.find("hamiltonian")->erase("rotor");
    } else if (!own) {
      reader.fail("rotor",
                  fmt::format("rotor is how splitting methods turn bodies, but '{}' turns them on their group; "
                              "take it out",
                              made.method));
    } else if (scene_.hamiltonian.rotating->rotor != *own) {
      reader.fail("rotor",
                  fmt::format("rotor = \"{}\" is not that of '{}', which is \"{}\"; take it out, or use 'verlet'",
                              rotor_name(scene_.hamiltonian.rotating->rotor), made.method, rotor_name(*own)));
    }
  }

  /// Refuses a box or constraints that the splitting does not know.
  void check_splitting(const TableReader& reader, const std::vector<const SceneValue*>& constraints) const {
    const SceneSplitting& splitting = scene_.hamiltonian.splitting;
    if (scene_.particles.box().is_periodic() && !splitting.claims().periodic) {
      reader.fail("type", fmt::format("{} does not support a periodic box; take the box out", splitting.name));
    }
    if (scene_.hamiltonian.rotating && !constraints.empty()) {
      reader.fail(constraints.front(), "constraint",
                  "constraints hold points, but some particles are rigid bodies, which are rigid without; take it out");
    }
    if (!splitting.make_constrained && !constraints.empty()) {
      reader.fail(constraints.front(), "constraint",
                  fmt::format("{} does not support constraints; use {}", splitting.name, plain_hamiltonian()));
    }
  }
  const std::string& plain_hamiltonian() const { return parts_.hamiltonians().front().info.name; }

  SceneValue read_neighbors(const SceneValue& table) {
    TableReader reader(context_, table, "[hamiltonian.neighbors]", "hamiltonian.neighbors");
    if (table.get<SceneValue::Table>() == nullptr) reader.wrong_kind(table, "neighbors", "a table");
    NeighborOptions options;
    read_part(reader, options);
    const SceneHamiltonian& made = scene_.hamiltonian;
    if (made.rotating) {
      reader.fail(nullptr, "neighbors",
                  "sites of rigid bodies have a neighbor list of their own, with the default options; take "
                  "[hamiltonian.neighbors] out");
    }
    const bool any = std::any_of(made.forces.begin(), made.forces.end(),
                                 [](const SceneForce& force) { return force.force.claims().range > 0; });
    if (!any || !made.splitting.claims().neighbors) {
      reader.fail(nullptr, "neighbors",
                  fmt::format("no force of {} has a cutoff, so [hamiltonian.neighbors] has no effect; take it out",
                              plain_hamiltonian()));
    }
    scene_.hamiltonian.neighbors = options;
    SceneValue effective = SceneValue::table();
    put_fields(reader, options, effective);
    return effective;
  }

  /// @param what  force or field: the list in which it stands
  void read_force(const SceneValue& table, const std::string& what, SceneValue::Array& list) {
    const std::string path = fmt::format("hamiltonian.{}.{}", what, list.size());
    const bool field = what == "field";
    refuse_other_list(table, path, field);
    const std::vector<Parts::ForceKind> kinds = forces_in(field);
    const auto [kind, type] = kind_of_part(context_, table, path, what, kinds, {});
    TableReader reader(context_, table, fmt::format("{} '{}'", what, type), path);
    SceneValue effective = SceneValue::table();
    SceneForce force = noether::read_force(reader, *kind, &scene_.particles, effective);
    check_force_beside(reader, *kind, force, scene_.hamiltonian, parts_);
    set_kick(reader, force);
    if (scene_.hamiltonian.rotating) check_force_on_bodies(reader, *kind, force, scene_.hamiltonian, scene_.particles);
    try {
      if (!sums_images_of(scene_.hamiltonian.splitting, force, scene_.particles))
        (force.letter ? force.force : scene_.hamiltonian.on_bodies(force.force)).check(scene_.particles);
    } catch (const Error& error) {
      const SceneValue* file = root_.find("particles")->find("structure");
      const bool of_file = error.key() == "structure" && file != nullptr;
      const std::string key = reader.has(error.key()) ? std::string(error.key()) : "type";
      reader.fail(key, error.message() + (of_file ? " " + to_text(*file) : ""));
    }
    list.push_back(effective);
    scene_.hamiltonian.forces.push_back(std::move(force));
  }

  /// @throws SceneError  for a force among the fields, and for a field among the forces
  void refuse_other_list(const SceneValue& table, const std::string& path, bool field) const {
    const SceneValue* type = table.find("type");
    const std::string* name = type != nullptr ? type->get<std::string>() : nullptr;
    for (const Parts::ForceKind& kind : parts_.forces()) {
      if (name == nullptr || kind.info.name != *name || kind.field == field) continue;
      const char* other = field ? "force" : "field";
      TableReader(context_, table, fmt::format("{} '{}'", other, *name), path)
          .fail("type", fmt::format("'{}' is a {}; write [[hamiltonian.{}]]", *name, other, other));
    }
  }
  /// Fields, or the forces that are none.
  std::vector<Parts::ForceKind> forces_in(bool field) const {
    std::vector<Parts::ForceKind> kinds;
    for (const Parts::ForceKind& kind : parts_.forces()) {
      if (kind.field == field) kinds.push_back(kind);
    }
    return kinds;
  }

  /// Whether frames are to have the sites of bodies. Only where they are, the effective scene says so: scenes from
  /// before there were any go on.
  bool frames_have_sites(TableReader& reader, SceneValue& effective) const {
    if (!reader.flag("sites", false)) return false;
    if (!io::has_several_sites(scene_.particles)) {
      reader.fail("sites",
                  "frames have the sites of rigid bodies beside their centres, but no body has more than one "
                  "site; take the key out");
    }
    effective.put("sites", SceneValue::of(true, reader.line("sites")));
    return true;
  }

  void read_watches(TableReader& top) {
    const auto tables = tables_of(top, "every");
    SceneValue::Array list;
    for (const SceneValue* table : tables) {
      const std::string path = fmt::format("every.{}", list.size());
      const auto [kind, type] =
          kind_of_part(context_, *table, path, "monitor", parts_.monitors(), {"trajectory", "checkpoint"});
      TableReader reader(context_, *table, fmt::format("monitor '{}'", type), path);
      reader.find("type");
      SceneValue effective = SceneValue::table();
      effective.put("type", SceneValue::of(type, reader.line("type")));
      SceneWatch watch;
      if (type == "trajectory") watch.kind = SceneWatch::Kind::trajectory;
      if (type == "checkpoint") watch.kind = SceneWatch::Kind::checkpoint;
      for (const char* key : {"every", "steps", "times", "after"}) reader.find(key);
      if (kind != nullptr) watch.monitor = kind->read(reader);
      if (kind == nullptr && type == "checkpoint") reader.find("wall");
      if (kind == nullptr && type == "trajectory") watch.sites = frames_have_sites(reader, effective);
      reader.finish();
      for (const SceneWatch& other : scene_.watches) {
        if (type == "trajectory" && other.kind == watch.kind) {
          reader.fail("type", "trajectory appears twice in the scene, but there is one run.h5; give one cadence");
        }
      }
      watch.cadence = read_cadence(reader, type == "checkpoint", scene_.integrator, effective);
      read_after(reader, scene_.integrator, watch.cadence, effective);
      if (kind != nullptr) {
        for (auto& [key, value] : *watch.monitor.effective.get<SceneValue::Table>()) effective.put(key, value);
      }
      list.push_back(std::move(effective));
      scene_.watches.push_back(std::move(watch));
    }
    scene_.effective.put("every", SceneValue::of(std::move(list), top.line("every")));  // defaults take this place
  }

  void read_stops(TableReader& top) {
    const auto tables = tables_of(top, "stop");
    SceneValue::Array list;
    if (scene_.system && !tables.empty()) {
      top.fail(tables.front(), "stop",
               fmt::format("a stop watches distances of particles, but system '{}' has none; take it out",
                           scene_.system->name));
    }
    if (scene_.particles.box().is_periodic() && !tables.empty()) {
      top.fail(tables.front(), "stop", "a stop does not support a periodic box; take the stop out");
    }
    for (const SceneValue* table : tables) {
      const std::string path = fmt::format("stop.{}", list.size());
      const auto [kind, type] = kind_of_part(context_, *table, path, "stop", parts_.stops(), {});
      TableReader reader(context_, *table, fmt::format("stop '{}'", type), path);
      for (const char* key : {"type", "every"}) reader.find(key);
      SceneStop stop = kind->read(reader);
      // A step that a method chooses may be a large part of an orbit, and a hundred of them the whole run.
      const bool escapes = stop.rule.kind == StopRule::Kind::escape;
      if (escapes && scene_.integrator.adaptive() && !reader.has("steps")) {
        stop.steps = 1;
        stop.effective.put("steps", SceneValue::of(stop.steps));
      }
      SceneValue effective = SceneValue::table();
      effective.put("type", SceneValue::of(type, reader.line("type")));
      for (auto& [key, value] : *stop.effective.get<SceneValue::Table>()) effective.put(key, value);
      if (reader.has("every")) {
        effective.erase("steps");
        SceneIntegrator at_steps = scene_.integrator;  // distances are looked at at whole steps
        at_steps.between_steps = false;
        stop.steps = read_cadence(reader, false, at_steps, effective).steps;
      }
      if (stop.steps == 0) {
        reader.fail(
            "every",
            fmt::format(
                "stop '{}' is checked at whole steps, but method '{}' chooses them; give steps instead of every", type,
                scene_.integrator.method));
      }
      note_pairs_left_out(reader, stop);
      list.push_back(std::move(effective));
      scene_.stops.push_back(std::move(stop));
    }
    if (!list.empty()) scene_.effective.put("stop", SceneValue::of(std::move(list)));
  }

  /// Tells that pairs without mass do not meet, where there are any.
  void note_pairs_left_out(const TableReader& reader, const SceneStop& stop) {
    const auto& masses = scene_.particles.masses();
    Index tracers = 0;
    for (Index i = 0; i < scene_.particles.size(); ++i) tracers += masses[i] == 0 ? 1 : 0;
    if (stop.rule.kind != StopRule::Kind::collision || tracers < 2) return;
    reader.note(
        reader.table(),
        fmt::format("pairs of the {} tracers, whose mass is 0, do not stop the run; give them masses if they may",
                    tracers));
  }

  /// Only who tests a scene reads what it expects: what is wrong there ends no run.
  void read_expectations(const SceneValue& expect) {
    const auto keep = [&](const std::string& path, const SceneValue& value, const std::string& wrong) {
      if (wrong.empty()) return;
      scene_.unread.push_back(scene_error(scene_.source, value.line, "expect." + path, "", wrong).what());
    };
    if (!expect.is_table()) {
      return keep("", expect, fmt::format("expect = {} is {}; a table is expected", to_text(expect), kind_of(expect)));
    }
    flatten_expectations(expect, "");
    for (const auto& [path, value] : scene_.expect) keep(path, value, wrong_expectation(path, value));
  }

  void flatten_expectations(const SceneValue& value, const std::string& path) {
    const auto* table = value.get<SceneValue::Table>();
    if (table == nullptr) {
      scene_.expect[path] = value;
      return;
    }
    for (const auto& [key, entry] : *table) flatten_expectations(entry, path.empty() ? key : path + "." + key);
  }

  /// The monitors by the names the run gives them: equal ones are numbered.
  std::vector<std::string> monitor_names() const {
    std::vector<std::string> names;
    for (const SceneWatch& watch : scene_.watches) {
      if (watch.kind != SceneWatch::Kind::monitor) continue;
      std::string name = watch.monitor.name;
      for (int k = 2; std::find(names.begin(), names.end(), name) != names.end(); ++k) {
        name = fmt::format("{}_{}", watch.monitor.name, k);
      }
      names.push_back(std::move(name));
    }
    return names;
  }

  /// Why no run of this scene could be compared with an expectation; "" where one can.
  std::string wrong_expectation(const std::string& path, const SceneValue& value) const {
    const std::size_t dot = path.rfind('.');
    const std::string monitor = path.substr(0, dot), figure = dot == std::string::npos ? "" : path.substr(dot + 1);
    const std::vector<std::string> names = monitor_names();
    if (std::find(names.begin(), names.end(), monitor) == names.end()) {
      return fmt::format("[expect] names '{}', which is not a monitor of this scene{}", monitor,
                         names.empty() ? "; it has no monitors" : did_you_mean(monitor, names));
    }
    if (figure.empty()) {
      return fmt::format("[expect] names no figure of '{0}'; expected one, such as {0}.worst", monitor);
    }
    const std::vector<std::string> figures = {"first", "last", "worst", "rms", "slope", "slope_error"};
    if (std::find(figures.begin(), figures.end(), figure) == figures.end()) {
      return fmt::format("[expect] names '{}' of '{}', which is not a figure{}", figure, monitor,
                         did_you_mean(figure, figures));
    }
    if (value.get<double>() == nullptr && value.get<std::int64_t>() == nullptr) {
      return fmt::format("{} = {} is {}; a number is expected", path, to_text(value), kind_of(value));
    }
    return "";
  }

  const SceneValue& root_;
  const Parts& parts_;
  Scene& scene_;
  SceneContext context_;
};

/// Reads a scene from its tree into `scene`. @return the run that was put together to check it
Simulation<double> read_into(Scene& scene, SceneValue root, const std::filesystem::path& file, const Parts& parts,
                             const std::vector<std::string>& sets) {
  scene.file = file;
  scene.parts = std::make_shared<const Parts>(parts);
  scene.source = {file.string(), sets};
  check_tree(root, scene.source);
  apply_sets(root, scene.source, parts);
  return SceneReader(root, *scene.parts, scene).read();
}

/// The text of a scene file. @throws SceneError, FileError
std::string scene_text(const std::filesystem::path& file) {
  if (file.empty()) throw SceneError("the name of the scene file is empty; give one, such as scene.toml");
  constexpr std::size_t largest = 64U << 20U;
  std::string text = io::read_bytes(file, largest + 1);
  if (text.size() > largest) {
    throw SceneError(
        "the file is too large for a scene; at most 64 MB are expected: put the bodies into a table, bodies = "
        "\"FILE.csv\"",
        {.file = file.string()});
  }
  return text;
}

}  // namespace

SceneRun read_run(SceneValue root, const std::filesystem::path& file, const Parts& parts,
                  const std::vector<std::string>& sets) {
  Scene scene;
  Simulation<double> start = read_into(scene, std::move(root), file, parts, sets);
  return {std::move(scene), std::move(start)};
}

SceneRun read_run(std::string_view text, const std::filesystem::path& file, const Parts& parts,
                  const std::vector<std::string>& sets) {
  return read_run(parse_toml(text, file.string()), file, parts, sets);
}

SceneRun load_run(const std::filesystem::path& file, const Parts& parts, const std::vector<std::string>& sets) {
  return read_run(scene_text(file), file, parts, sets);
}

Scene read_scene(SceneValue root, const std::filesystem::path& file, const Parts& parts,
                 const std::vector<std::string>& sets) {
  Scene scene;
  read_into(scene, std::move(root), file, parts, sets);
  return scene;
}

Scene read_scene(std::string_view text, const std::filesystem::path& file, const Parts& parts,
                 const std::vector<std::string>& sets) {
  return read_scene(parse_toml(text, file.string()), file, parts, sets);
}

Scene load_scene(const std::filesystem::path& file, const Parts& parts, const std::vector<std::string>& sets) {
  return read_scene(scene_text(file), file, parts, sets);
}

}  // namespace noether

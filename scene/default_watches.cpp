#include "scene/default_watches.hpp"

#include "monitors/monitors.hpp"
#include "scene/toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace noether {

namespace {

constexpr std::int64_t wanted_frames = 200;
constexpr double most_bytes = 2e9;
const std::string kept_watches_part = "kept_watches";

/// So many frames are wanted, and so many more are allowed.
struct FrameRoom {
  std::int64_t wanted, most;
};

FrameRoom room_for_frames(const ParticleSystem<double>& s) {
  const auto numbers = static_cast<double>(6 * s.size()) + static_cast<double>(s.variables().size());
  const double fit = most_bytes / (8 * std::max(numbers, 1.0));
  const std::int64_t most = std::clamp(static_cast<std::int64_t>(fit), std::int64_t{2}, 2 * wanted_frames);
  return {std::min(wanted_frames, most), most};
}

/// A divisor of all steps where one gives half to twice the frames that are wanted, so that the last frame is the end.
/// It must not be made a frame where it is not due: a run that goes on from there would have a frame too many.
std::int64_t steps_between(std::int64_t steps, const FrameRoom& room) {
  const std::int64_t wanted = room.wanted;
  for (std::int64_t off = 0; off <= std::max(wanted / 2, room.most - wanted); ++off) {
    for (const std::int64_t frames : {wanted + off, wanted - off}) {
      const bool near = frames >= std::max<std::int64_t>(wanted / 2, 1) && frames <= room.most;
      if (near && steps >= frames && steps % frames == 0) return steps / frames;
    }
  }
  return std::max<std::int64_t>((steps + wanted / 2) / wanted, 1);
}

/// A length divided into so many parts, without what rounding alone has added: 0.036, not 0.036000000000000004.
double part_of(double length, std::int64_t parts) {
  const double part = length / static_cast<double>(parts), written = std::stod(fmt::format("{:.15g}", part));
  return std::abs(written - part) <= std::numeric_limits<double>::epsilon() * std::abs(part) ? written : part;
}

/// When default watches look, and how a scene says it.
struct DefaultCadence {
  Cadence cadence;
  std::string key;
  SceneValue value;
};

/// A cadence as a stored table has it; empty if it has none of steps or time.
std::optional<DefaultCadence> read_cadence(const SceneContext& context, const SceneValue& table) {
  DefaultCadence made;
  const TableReader reader(context, table, "[[every]]", "every");
  if (const SceneValue* steps = table.find("steps"); steps != nullptr && steps->get<std::int64_t>() != nullptr) {
    made.cadence.steps = *steps->get<std::int64_t>();
    made.key = "steps";
    made.value = *steps;
    return made;
  }
  const SceneValue* every = table.find("every");
  if (every == nullptr) return {};
  made.cadence.interval = reader.number(*every, "every", "time");
  made.key = "every";
  made.value = *every;
  return made;
}

/// The cadence of about so many frames over a whole run; empty where it has no end.
std::optional<DefaultCadence> cadence_of(const SceneContext& context, const Scene& scene,
                                         const SceneIntegrator& integrator) {
  const FrameRoom room = room_for_frames(scene.particles);
  SceneValue table = SceneValue::table();
  if (integrator.steps) {
    table.put("steps", SceneValue::of(steps_between(*integrator.steps, room)));
  } else if (const auto length = integrator.length()) {
    table.put("every", detail::quantity_value(part_of(*length, room.wanted), "time", *scene.units));
  } else {
    return {};
  }
  return read_cadence(context, table);  // from the text that is stored, so that both are one to the bit
}

/// The integrator of a scene with the end that the stored one had.
SceneIntegrator with_end_of(const SceneContext& context, const SceneValue& stored, SceneIntegrator integrator) {
  const SceneValue* table = stored.find("integrator");
  if (table == nullptr) return integrator;
  TableReader reader(context, *table, "[integrator]", "integrator");
  if (reader.has("steps")) integrator.steps = reader.integer("steps");
  const std::optional<double> until = reader.quantity("until", "time");
  if (until && integrator.until) integrator.until = until;
  if (until && !integrator.until && integrator.step != 0) {
    const double exact = (*until - integrator.start) / integrator.step, whole = std::round(exact);
    integrator.steps = static_cast<std::int64_t>(std::abs(exact - whole) < 1e-6 ? whole : std::ceil(exact));
  }
  return integrator;
}

SceneValue table_of(const SceneWatch& watch, const std::string& type, const DefaultCadence& when) {
  SceneValue table = SceneValue::table();
  table.put("type", SceneValue::of(type));
  table.put(when.key, when.value);
  if (watch.kind != SceneWatch::Kind::monitor) return table;
  for (const auto& [key, value] : *watch.monitor.effective.get<SceneValue::Table>()) table.put(key, value);
  return table;
}

/// The monitor of the energy, as a scene's parts read it; empty where they know none.
std::optional<SceneMonitor> energy_monitor(const SceneContext& context, const Parts& parts) {
  const SceneValue nothing = SceneValue::table();
  for (const Parts::MonitorKind& kind : parts.monitors()) {
    if (kind.info.name != part_name<Energy>()) continue;
    TableReader reader(context, nothing, "[[every]]", "every");
    return kind.read(reader);
  }
  return {};
}

/// Adds "energy at steps = 18" to a list in words.
void add_cadence(std::string& list, const std::string& type, const DefaultCadence& when) {
  list += fmt::format("{}{} at {} = {}", list.empty() ? "" : ", ", type, when.key, to_text(when.value));
}

void put_watches(Scene& scene, SceneValue::Array tables) {
  if (tables.empty()) {
    scene.effective.erase("every");
  } else {
    scene.effective.put("every", SceneValue::of(std::move(tables)));
  }
}

}  // namespace

void add_default_watches(const SceneContext& context, Scene& scene, const IntegratorClaims& claims) {
  scene.default_watches = true;
  SceneValue::Array tables;
  const std::optional<DefaultCadence> when = cadence_of(context, scene, scene.integrator);
  if (when && claims.energy) {  // every force tells its own
    if (auto energy = energy_monitor(context, *scene.parts)) {
      SceneWatch watch{SceneWatch::Kind::monitor, std::move(*energy), when->cadence};
      tables.push_back(table_of(watch, watch.monitor.name, *when));
      scene.watches.push_back(std::move(watch));
    }
  }
  if (when && NOETHER_HDF5 != 0) {
    const SceneWatch watch{SceneWatch::Kind::trajectory, {}, when->cadence};
    tables.push_back(table_of(watch, "trajectory", *when));
    scene.watches.push_back(watch);
  }
  put_watches(scene, std::move(tables));
}

std::string keep_default_watches(const SceneValue& stored, Scene& scene) {
  const SceneValue* list = stored.find("every");
  const auto* tables = list != nullptr ? list->get<SceneValue::Array>() : nullptr;
  SceneValue::Array kept;
  std::vector<SceneWatch> watches;
  std::string changed;
  if (tables != nullptr && !tables->empty()) {  // a run begun before there were defaults goes on without
    if (tables->size() != scene.watches.size()) return "";
    SceneContext context;
    context.units = scene.units;
    const auto begun = cadence_of(context, scene, with_end_of(context, stored, scene.integrator));
    for (std::size_t k = 0; k < tables->size(); ++k) {
      SceneWatch watch = scene.watches[k];
      const std::string type = watch.kind == SceneWatch::Kind::monitor ? watch.monitor.name : "trajectory";
      const SceneValue* written = (*tables)[k].find("type");
      const auto when = read_cadence(context, (*tables)[k]);
      if (written == nullptr || to_text(*written) != to_text(SceneValue::of(type)) || !when) return "";
      const bool same =
          begun && begun->cadence.steps == when->cadence.steps && begun->cadence.interval == when->cadence.interval;
      if (!same) add_cadence(changed, type, *when);
      watch.cadence = when->cadence;
      kept.push_back(table_of(watch, type, *when));
      watches.push_back(std::move(watch));
    }
  }
  scene.watches = std::move(watches);
  put_watches(scene, std::move(kept));
  scene.kept_watches = true;
  scene.effective_toml = print_toml(scene.effective);
  if (changed.empty()) return "";
  return fmt::format("the scene has no [[every]], so the run keeps the cadence it began with: {}", changed);
}

std::map<std::string, SavedState> mark_of_kept_watches(const Scene& scene) {
  std::map<std::string, SavedState> mark;
  if (scene.kept_watches) save_value(mark[kept_watches_part], "kept", true);
  return mark;
}

bool told_of_kept_watches(const SavedRun& run) { return run.parts.contains(kept_watches_part); }

}  // namespace noether

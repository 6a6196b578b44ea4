#include "scene/resume.hpp"

#include "scene/toml.hpp"

#include <fmt/format.h>

#include <map>

namespace noether {

namespace {

constexpr std::array<std::string_view, 6> free_keys = {
    "title", "expect", "verdict", "integrator.until", "integrator.steps", "integrator.exact"};

struct Leaf {
  std::string text;
  int line = 0;
};

void flatten(const SceneValue& value, const std::string& path, std::map<std::string, Leaf>& leaves) {
  const auto below = [&](const std::string& key) { return path.empty() ? key : path + "." + key; };
  for (const std::string_view key : free_keys) {
    if (path == key) return;
  }
  if (const auto* table = value.get<SceneValue::Table>()) {
    for (const auto& [key, entry] : *table) flatten(entry, below(key), leaves);
  } else if (value.is_table_list()) {
    std::size_t k = 0;
    for (const SceneValue& entry : std::get<SceneValue::Array>(value.data))
      flatten(entry, below(std::to_string(k++)), leaves);
  } else if (path != "every") {  // `every = []` is a scene without watches, as those without the key once were
    leaves[path] = {to_text(value), value.line};
  }
}

[[noreturn]] void refuse(const Scene& scene, const std::string& key, const Leaf& leaf, const std::string& change) {
  throw scene_error(
      scene.source, leaf.line, key, leaf.text,
      fmt::format("{} {}; a resumed run may change only its end, to a later one: undo this, or start over with --fresh",
                  key, change));
}

/// The bodies of another run's last frame, which has got later ones since.
void check_frame(const Scene& scene, const std::map<std::string, Leaf>& before,
                 const std::map<std::string, Leaf>& now) {
  const std::string key = "particles.frame";
  const auto old = before.find(key), found = now.find(key);
  if (old == before.end() || found == now.end() || old->second.text == found->second.text) return;
  const auto bodies = now.find("particles.bodies");
  if (bodies == now.end() || before.count("particles.bodies_sha256") == 0) return;
  throw scene_error(scene.source, found->second.line, key, found->second.text,
                    fmt::format("the run began with frame {} of {}, but this would be frame {}; give frame = {} in "
                                "[particles], or start over with --fresh",
                                old->second.text, bodies->second.text, found->second.text, old->second.text));
}

/// Whether a key that is gone stood there only because it had a default: the absolute tolerance of particles.
bool was_default(const std::string& key, const std::string& text) {
  return key == "integrator.atol" && (text == to_text(SceneValue::of(1e-9)) || text == to_text(SceneValue::of(0.0)));
}

/// Whether a stop that the scene says no steps of is looked at more often than by an earlier version.
bool was_seldom(const std::string& key, const Leaf& leaf, const std::string& old) {
  return leaf.line == 0 && key.starts_with("stop.") && key.ends_with(".steps") && old == "100" && leaf.text == "1";
}

}  // namespace

std::vector<std::string> check_same_scene(const io::Checkpoint& checkpoint, const Scene& scene) {
  std::vector<std::string> warnings;
  std::map<std::string, Leaf> before, now;
  flatten(parse_toml(checkpoint.scene_toml, "the scene in the checkpoint"), "", before);
  flatten(scene.effective, "", now);
  check_frame(scene, before, now);
  for (const auto& [key, leaf] : now) {
    const auto old = before.find(key);
    if (old == before.end()) refuse(scene, key, leaf, fmt::format("= {} is new", leaf.text));
    if (was_seldom(key, leaf, old->second.text)) {
      warnings.push_back(fmt::format("{} was {}, the default of an earlier version; from here on it is {}", key,
                                     old->second.text, leaf.text));
      continue;
    }
    if (old->second.text != leaf.text)
      refuse(scene, key, leaf, fmt::format("= {} was {}", leaf.text, old->second.text));
  }
  for (const auto& [key, leaf] : before) {
    if (now.find(key) != now.end()) continue;
    if (!was_default(key, leaf.text)) refuse(scene, key, {leaf.text, 0}, fmt::format("= {} is missing now", leaf.text));
    warnings.push_back(
        fmt::format("the run was begun with {} = {}, the default of an earlier version; from here on errors of "
                    "particles are measured in a different way, without it (docs/theory/adaptive_steps.md)",
                    key, leaf.text));
  }
  return warnings;
}

void save_ending(SavedRun& run, const Ending& ending) {
  SavedState& state = run.parts["ending"];
  const Outcome& outcome = ending.outcome;
  save_value(state, "kind", outcome.kind);
  save_value(state, "message", outcome.message);
  save_value(state, "quantity", outcome.quantity);
  save_value(state, "has_particle", outcome.particle.has_value());
  if (outcome.particle) {
    save_value(state, "particle", std::vector<std::int64_t>{outcome.particle->index, outcome.particle->id});
    save_value(state, "particle_name", outcome.particle->name);
  }
  save_value(state, "wall_s", ending.wall_s);
  save_value(state, "steps_made", ending.steps_made);
}

Ending load_ending(const io::Checkpoint& checkpoint) {
  const auto found = checkpoint.run.parts.find("ending");
  if (found == checkpoint.run.parts.end()) throw Error("the checkpoint does not say how its run ended; use --fresh");
  const SavedState& state = found->second;
  Ending ending;
  Outcome& outcome = ending.outcome;
  outcome.step = checkpoint.step;
  outcome.time = checkpoint.time;
  std::int64_t kind = 0;
  load_value(state, "kind", kind);
  outcome.kind = detail::enumerator(kind, Outcome::Kind::inverted_element);
  load_value(state, "message", outcome.message);
  load_value(state, "quantity", outcome.quantity);
  bool has_particle = false;
  load_value(state, "has_particle", has_particle);
  if (has_particle) {
    std::vector<std::int64_t> numbers;
    ParticleRef particle;
    load_value(state, "particle", numbers);
    load_value(state, "particle_name", particle.name);
    particle.index = detail::element(numbers, 0);
    particle.id = detail::element(numbers, 1);
    outcome.particle = particle;
  }
  load_value(state, "wall_s", ending.wall_s);
  load_value(state, "steps_made", ending.steps_made);
  return ending;
}

}  // namespace noether

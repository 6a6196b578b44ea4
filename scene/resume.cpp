#include "scene/resume.hpp"

#include "scene/toml.hpp"

#include <fmt/format.h>

#include <map>

namespace noether {

namespace {

constexpr std::array<std::string_view, 4> free_keys = {"title", "expect", "integrator.until", "integrator.steps"};

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
  } else {
    leaves[path] = {to_text(value), value.line};
  }
}

[[noreturn]] void refuse(const Scene& scene, const std::string& key, const Leaf& leaf, const std::string& change) {
  throw scene_error(
      scene.source, leaf.line, key, leaf.text,
      fmt::format("{} {}; a resumed run takes only a later end: undo this, or start over with --fresh", key, change));
}

}  // namespace

void check_same_scene(const io::Checkpoint& checkpoint, const Scene& scene) {
  std::map<std::string, Leaf> before, now;
  flatten(parse_toml(checkpoint.scene_toml, "the scene in the checkpoint"), "", before);
  flatten(scene.effective, "", now);
  for (const auto& [key, leaf] : now) {
    const auto old = before.find(key);
    if (old == before.end()) refuse(scene, key, leaf, fmt::format("= {} is new", leaf.text));
    if (old->second.text != leaf.text)
      refuse(scene, key, leaf, fmt::format("= {} was {}", leaf.text, old->second.text));
  }
  for (const auto& [key, leaf] : before) {
    if (now.find(key) == now.end()) refuse(scene, key, {leaf.text, 0}, fmt::format("= {} is gone", leaf.text));
  }
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
  outcome.kind = detail::enumerator(kind, Outcome::Kind::overstretch);
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

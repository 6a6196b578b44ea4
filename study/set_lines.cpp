#include "study/set_lines.hpp"

#include "engine/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace noether {

namespace {

std::string time_text(double time, const UnitSystem& units) {
  if (units.is_reduced()) return format_number(time);
  return fmt::format("\"{} {}\"", format_number(time), units.time);
}

/// The scene's forces with gravity in front, as a list of tables.
std::string forces_with_gravity(const SceneValue& hamiltonian) {
  SceneValue gravity = SceneValue::table();
  gravity.put("type", SceneValue::of(std::string("gravity")));
  if (const SceneValue* G = hamiltonian.find("G")) gravity.put("G", *G);
  SceneValue::Array all = {std::move(gravity)};
  const SceneValue* forces = hamiltonian.find("force");
  if (const auto* list = forces != nullptr ? forces->get<SceneValue::Array>() : nullptr) {
    all.insert(all.end(), list->begin(), list->end());
  }
  return to_text(SceneValue::of(std::move(all)));
}

std::vector<std::string> wanted(const Scene& scene, const Opponent& who, const Setting& setting, double end) {
  std::vector<std::string> lines;
  if (who.hamiltonian != scene.hamiltonian.kind) {
    lines = {"hamiltonian.type=kinetic_potential",
             "hamiltonian.force=" + forces_with_gravity(*scene.effective.find("hamiltonian"))};
  }
  const bool counts_steps = scene.effective.find("integrator")->find("steps") != nullptr;
  lines.push_back("integrator.method=" + who.method);
  if (who.adaptive) {
    lines.push_back("integrator.rtol=" + format_number(setting.tolerance));
    lines.push_back("integrator.atol=" + format_number(absolute_tolerance(scene, setting.tolerance)));
    if (counts_steps) lines.push_back("integrator.until=" + time_text(end, *scene.units));
    return lines;
  }
  lines.push_back("integrator.step=" + time_text(setting.step, *scene.units));
  if (scene.integrator.steps && counts_steps) {
    lines.push_back(fmt::format("integrator.steps={}", std::llround(end / setting.step)));
  }
  return lines;
}

/// Whether a key is one that lines may take out.
bool may_go(const std::string& key, const std::vector<std::string>& lines) {
  if (!key.starts_with("integrator.") && key != "hamiltonian.coordinates") return false;
  return std::none_of(lines.begin(), lines.end(), [&](const std::string& line) { return line.starts_with(key + "="); });
}

}  // namespace

SetLines set_lines(const Scene& scene, const Opponent& who, const Setting& setting, double end) {
  SetLines result{.lines = wanted(scene, who, setting, end)};
  if (!std::filesystem::exists(scene.file)) return result;
  for (;;) {
    std::vector<std::string> all = scene.source.sets;
    all.insert(all.end(), result.lines.begin(), result.lines.end());
    try {
      load_scene(scene.file, standard_parts(), all);
      return result;
    } catch (const Error& error) {
      if (!may_go(error.key(), result.lines)) {
        result.refusal = error.message();
        return result;
      }
      result.lines.insert(result.lines.begin(), error.key() + "=");  // each key once: this ends
    }
  }
}

}  // namespace noether

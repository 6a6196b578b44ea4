#include "study/set_lines.hpp"

#include "numbers/quantity.hpp"

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

/// The scene's forces with those of its splitting in front, as a list of tables.
std::string all_forces(const Scene& scene, const SceneValue& hamiltonian) {
  SceneValue::Array all;
  for (const SceneForce& force : scene.hamiltonian.splitting.own) {
    SceneValue table = SceneValue::table();
    table.put("type", SceneValue::of(force.name));
    for (const auto& [key, value] : *force.effective.get<SceneValue::Table>()) table.put(key, value);
    const SceneValue* G = hamiltonian.find("G");
    if (G != nullptr && force.force.claims().kepler) table.put("G", *G);
    all.push_back(std::move(table));
  }
  const SceneValue* forces = hamiltonian.find("force");
  if (const auto* list = forces != nullptr ? forces->get<SceneValue::Array>() : nullptr) {
    all.insert(all.end(), list->begin(), list->end());
  }
  return to_text(SceneValue::of(std::move(all)));
}

/// Takes away what changes the scene's own scheme, and was not tried with another one.
void leave_processing_out(const Scene& scene, std::vector<std::string>& lines) {
  const SceneValue& written = *scene.effective.find("integrator");
  for (const char* key : {"corrector", "kernel", "second_corrector", "inner_steps"}) {
    if (written.find(key) != nullptr) lines.push_back(fmt::format("integrator.{}=", key));
  }
}

std::vector<std::string> wanted(const Scene& scene, const Candidate& who, const Setting& setting, double end) {
  std::vector<std::string> lines;
  if (who.joined) {
    lines = {"hamiltonian.type=" + scene.parts->hamiltonians().front().info.name,
             "hamiltonian.force=" + all_forces(scene, *scene.effective.find("hamiltonian"))};
  }
  const bool counts_steps = scene.effective.find("integrator")->find("steps") != nullptr;
  lines.push_back("integrator.method=" + who.method);
  if (who.method != scene.integrator.method || who.joined) leave_processing_out(scene, lines);
  if (who.adaptive) {
    lines.push_back("integrator.rtol=" + format_number(setting.tolerance));
    if (const std::optional<double> least = absolute_tolerance(scene, setting.tolerance))
      lines.push_back("integrator.atol=" + format_number(*least));
    if (counts_steps) lines.push_back("integrator.until=" + time_text(scene.integrator.start + end, *scene.units));
    return lines;
  }
  lines.push_back("integrator.step=" + time_text(setting.step, *scene.units));
  if (scene.integrator.steps && counts_steps) {
    lines.push_back(fmt::format("integrator.steps={}", std::llround(end / setting.step)));
  }
  return lines;
}

/// Whether a key is one that lines may take out.
bool may_go(const Scene& scene, const std::string& key, const std::vector<std::string>& lines) {
  const bool of_splitting = key.starts_with("hamiltonian.") &&
                            scene.hamiltonian.splitting.effective.find(key.substr(key.find('.') + 1)) != nullptr;
  const auto& decorators = scene.integrator.decorators;
  const bool of_decorator = std::any_of(decorators.begin(), decorators.end(), [&](const SceneDecorator& one) {
    return key == one.path || key.starts_with(one.path + ".");
  });
  const bool of_integrator = key.starts_with("integrator.") && !of_decorator;
  if (!of_integrator && !of_splitting) return false;
  return std::none_of(lines.begin(), lines.end(), [&](const std::string& line) { return line.starts_with(key + "="); });
}

}  // namespace

SetLines set_lines(const Scene& scene, const Candidate& who, const Setting& setting, double end) {
  SetLines result{.lines = wanted(scene, who, setting, end)};
  if (!std::filesystem::is_regular_file(scene.file)) return result;
  for (;;) {
    std::vector<std::string> all = scene.source.sets;
    all.insert(all.end(), result.lines.begin(), result.lines.end());
    try {
      load_scene(scene.file, *scene.parts, all);
      return result;
    } catch (const Error& error) {
      if (!may_go(scene, error.key(), result.lines)) {
        result.refusal = error.message();
        return result;
      }
      result.lines.insert(result.lines.begin(), error.key() + "=");  // each key once: this ends
    }
  }
}

}  // namespace noether

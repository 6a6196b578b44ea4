#include "cli/run_caption.hpp"

#include "numbers/error.hpp"
#include "numbers/units.hpp"
#include "scene/parts.hpp"
#include "scene/toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace noether {

const SceneValue* value_at(const SceneValue& scene, const std::vector<std::string_view>& keys) {
  const SceneValue* value = &scene;
  for (const std::string_view key : keys) {
    if (value != nullptr) value = value->find(key);
  }
  return value;
}

std::string text_at(const SceneValue& scene, const std::vector<std::string_view>& keys) {
  const SceneValue* value = value_at(scene, keys);
  if (value == nullptr) return "";
  const std::string* text = value->get<std::string>();
  return text != nullptr ? *text : to_text(*value);
}

std::vector<const SceneValue*> tables_at(const SceneValue& scene, const std::vector<std::string_view>& keys) {
  std::vector<const SceneValue*> tables;
  const SceneValue* found = value_at(scene, keys);
  if (found == nullptr || !found->is_table_list()) return tables;
  for (const SceneValue& one : *found->get<SceneValue::Array>()) tables.push_back(&one);
  return tables;
}

ReadableTime readable_time(const std::string& unit, double longest) {
  namespace solar = units::solar;
  struct Choice {
    const char *of, *name;
    double length, from;
  };
  static constexpr std::array<Choice, 4> choices = {{{"day", "yr", solar::year, 2 * solar::year},
                                                     {"day", "kyr", solar::kyr, 5 * solar::kyr},
                                                     {"day", "Myr", solar::Myr, 0.5 * solar::Myr},
                                                     {"ps", "ns", 1000, 2000}}};
  ReadableTime time{unit == "1" ? "" : unit, 1};
  for (const Choice& choice : choices) {
    if (unit == choice.of && longest >= choice.from) time = {choice.name, choice.length};
  }
  return time;
}

double shown_time(double begin, double end) {
  const double span = std::abs(end - begin);
  return span > 0 ? span : std::abs(end);
}

namespace {

/// Whether a force takes energy away or depends on time.
bool is_driven(const SceneValue& force, const Parts& parts) {
  const std::string type = text_at(force, {"type"});
  return std::any_of(parts.forces().begin(), parts.forces().end(), [&](const Parts::ForceKind& kind) {
    return kind.info.name == type && (kind.claims.dissipative || kind.claims.time_dependent);
  });
}

/// The name of the folder without ".out": "orbit" of orbit.out/run.h5; of a file of another name that name.
std::string name_of_run(const std::filesystem::path& file) {
  if (file.stem() != "run") return file.stem().string();
  const std::filesystem::path folder = std::filesystem::absolute(file).lexically_normal().parent_path().filename();
  const std::string name = (folder.extension() == ".out" ? folder.stem() : folder).string();
  return name.empty() ? file.filename().string() : name;
}

}  // namespace

SceneValue scene_in_file(const std::string& toml, const std::filesystem::path& file) {
  try {
    return parse_toml(toml, "stored");
  } catch (const Error& error) {
    throw FileError(fmt::format("damaged: its scene cannot be read: {}", error.message()), {.file = file.string()});
  }
}

RunCaption caption_of(const SceneValue& scene, const std::filesystem::path& file, const std::string& time_unit,
                      double longest, const Parts& parts) {
  RunCaption caption;
  caption.title = text_at(scene, {"title"});
  if (caption.title.empty()) caption.title = name_of_run(file);
  const std::string step = text_at(scene, {"integrator", "step"});
  for (const std::string& part : {text_at(scene, {"hamiltonian", "type"}), text_at(scene, {"system", "type"}),
                                  text_at(scene, {"integrator", "method"}), step.empty() ? step : "step " + step}) {
    if (!part.empty()) caption.method += (caption.method.empty() ? "" : ", ") + part;
  }
  caption.time = readable_time(time_unit, longest);
  caption.energy_changes = value_at(scene, {"hamiltonian", "thermostat"}) != nullptr;
  for (const char* key : {"force", "field"}) {
    for (const SceneValue* force : tables_at(scene, {"hamiltonian", key})) {
      caption.energy_changes |= is_driven(*force, parts);
    }
  }
  return caption;
}

}  // namespace noether

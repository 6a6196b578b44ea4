#include "scene/key_paths.hpp"

#include "engine/neighbor_options.hpp"
#include "integrators/composition_options.hpp"
#include "integrators/minimize.hpp"
#include "integrators/rotating.hpp"
#include "scene/foreign_names.hpp"
#include "scene/read_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace noether {

namespace {

std::string text_at(const SceneValue& table, std::string_view key) {
  const SceneValue* value = table.find(key);
  const std::string* text = value != nullptr ? value->get<std::string>() : nullptr;
  return text != nullptr ? *text : "";
}

std::string in_quotes_if_dotted(const std::string& key) {
  return key.find('.') == std::string::npos ? key : "\"" + key + "\"";
}

template <class Kind>
void add_fields(std::vector<std::string>& keys, const std::vector<Kind>& kinds, const std::string& type) {
  for (const Kind& kind : kinds) {
    if (kind.info.name != type) continue;
    for (const auto& field : kind.info.fields) keys.push_back(field.name);
  }
}

/// Walks a scene, table by table.
class PathCollector {
 public:
  explicit PathCollector(const Parts& parts) : parts_(parts) {}

  std::vector<std::string> take() { return std::move(paths_); }

  /// @param path  of the table, with a dot at its end; empty for the scene itself
  /// @param key  under which it stands
  void table(const SceneValue& at, const std::string& path, const std::string& key) {
    for (const std::string& one : fields_of(at, key)) {
      if (at.find(one) == nullptr) paths_.push_back(path + one);
    }
    for (const auto& [name, value] : *at.get<SceneValue::Table>()) {
      const std::string below = path + in_quotes_if_dotted(name);
      if (value.is_table()) {
        table(value, below + ".", name);
      } else if (value.is_table_list()) {
        list(*value.get<SceneValue::Array>(), below + ".", name);
      } else {
        paths_.push_back(below);
      }
    }
  }

 private:
  void list(const SceneValue::Array& all, const std::string& path, const std::string& key) {
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (all[k].is_table()) table(all[k], path + name_in(all, k) + ".", key);
    }
  }

  /// How `--set` can call an element: by its type or its name, where no other one has it, else by its number.
  static std::string name_in(const SceneValue::Array& all, std::size_t k) {
    for (const char* key : {"type", "name"}) {
      const std::string name = text_at(all[k], key);
      const auto has_it = [&](const SceneValue& one) {
        return text_at(one, "type") == name || text_at(one, "name") == name;
      };
      if (!name.empty() && std::count_if(all.begin(), all.end(), has_it) == 1) return in_quotes_if_dotted(name);
    }
    return std::to_string(k);
  }

  std::vector<std::string> fields_of(const SceneValue& at, const std::string& key) const {
    std::vector<std::string> keys;
    const std::string type = text_at(at, "type");
    if (key == "integrator") add_integrator(keys);
    if (key == "particles") add_fields(keys, builders(), type);
    if (key == "hamiltonian") {
      add_fields(keys, parts_.hamiltonians(), type);
      keys.insert(keys.end(), {"type", "G", "force", "field", "constraint", "thermostat", "neighbors"});
      for_each_field<RotatingOptions>([&](const auto& f) { keys.emplace_back(f.name); });
    }
    if (key == "force") {
      add_fields(keys, parts_.forces(), type);
      keys.insert(keys.end(), {"type", "kick"});
    }
    if (key == "field") {
      add_fields(keys, parts_.forces(), type);
      keys.emplace_back("type");
    }
    if (key == "minimize") for_each_field<MinimizeOptions>([&](const auto& f) { keys.emplace_back(f.name); });
    if (key == "neighbors") for_each_field<NeighborOptions>([&](const auto& f) { keys.emplace_back(f.name); });
    if (key == "stop") keys.emplace_back("every");
    if (key == "thermostat") add_fields(keys, parts_.thermostats(), type);
    if (key == "constraint") add_fields(keys, parts_.constraints(), type);
    if (key == "system") add_fields(keys, parts_.systems(), type);
    add_fields(keys, parts_.decorators(), key);  // one under its own name
    if (key == "decorator") add_fields(keys, parts_.decorators(), type);
    if (key == "stop") add_fields(keys, parts_.stops(), type);
    if (key == "every") keys.emplace_back("after");
    if (key == "every") add_fields(keys, parts_.monitors(), type);
    return keys;
  }

  void add_integrator(std::vector<std::string>& keys) const {
    keys.insert(keys.end(), {"method", "step", "start_time", "until", "steps", "exact", "decorator"});
    for (const auto& kind : parts_.decorators()) keys.push_back(kind.info.name);
    for_each_field<CompositionOptions>([&](const auto& field) { keys.emplace_back(field.name); });
    for (const OptionGroup* group : parts_.method_options()) {
      for (const OptionValue& one : group->values({})) keys.emplace_back(one.name);
    }
  }

  const Parts& parts_;
  std::vector<std::string> paths_;
};

/// Whether a path ends in a key and has others before it, in order.
bool leads_to(const std::vector<std::string>& path, const std::vector<std::string>& before, const std::string& last) {
  if (path.back() != last) return false;
  auto at = path.begin();
  for (const std::string& one : before) {
    at = std::find(at, path.end() - 1, one);
    if (at == path.end() - 1) return false;
    ++at;
  }
  return true;
}

/// The element of a list that has a number, a type or a name; null where none has, or several have.
const SceneValue* element_of(const SceneValue::Array& list, const std::string& key) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
  if (error == std::errc() && end == key.data() + key.size()) return index < list.size() ? &list[index] : nullptr;
  const auto has_it = [&](const SceneValue& one) { return text_at(one, "type") == key || text_at(one, "name") == key; };
  if (std::count_if(list.begin(), list.end(), has_it) != 1) return nullptr;
  return &*std::find_if(list.begin(), list.end(), has_it);
}

}  // namespace

const SceneValue* find_path(const SceneValue& scene, std::string_view path) {
  const SceneValue* at = &scene;
  for (const std::string& key : keys_of_path(path)) {
    const auto* list = at->get<SceneValue::Array>();
    at = list != nullptr ? element_of(*list, key) : at->find(key);
    if (at == nullptr) return nullptr;
  }
  return at;
}

std::vector<std::string> keys_of_path(std::string_view path) {
  std::vector<std::string> keys(1);
  bool quoted = false;
  for (const char c : path) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == '.' && !quoted) {
      keys.emplace_back();
    } else {
      keys.back() += c;
    }
  }
  return keys;
}

std::vector<std::string> key_paths(const SceneValue& scene, const Parts& parts) {
  PathCollector collector(parts);
  collector.table(scene, "", "");
  return collector.take();
}

std::vector<std::string> paths_meant(std::string_view given, const std::vector<std::string>& paths) {
  std::vector<std::string> before = keys_of_path(given);
  std::vector<std::string> names = keys_here(before.back());
  names.insert(names.begin(), before.back());
  before.pop_back();
  std::vector<std::string> meant;
  for (const std::string& name : names) {
    for (const std::string& path : paths) {
      if (path != given && leads_to(keys_of_path(path), before, name)) meant.push_back(path);
    }
    if (!meant.empty()) break;
  }
  return meant;
}

}  // namespace noether

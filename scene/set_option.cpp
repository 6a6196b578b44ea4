#include "scene/set_option.hpp"

#include "numbers/suggest.hpp"
#include "numbers/text.hpp"
#include "scene/key_paths.hpp"
#include "scene/toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace noether {

namespace {

/// Tables and lists of tables a scene may have without having been written.
constexpr std::array<std::string_view, 5> known_tables = {"particles", "hamiltonian", "system", "integrator", "expect"};
/// The same of tables in [hamiltonian].
constexpr std::array<std::string_view, 2> known_of_hamiltonian = {"neighbors", "thermostat"};

/// Keys of one table of which at most one is given.
constexpr std::array<std::array<std::string_view, 4>, 3> alternatives = {
    {{"steps", "until", "", ""}, {"steps", "every", "wall", "times"}, {"density", "constant", "", ""}}};

std::string text_of(const SceneValue& table, std::string_view key) {
  const SceneValue* value = table.find(key);
  const std::string* text = value != nullptr ? value->get<std::string>() : nullptr;
  return text != nullptr ? *text : "";
}

void add_new(std::vector<std::string>& names, std::string_view name) {
  if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.emplace_back(name);
}

/// One `--set` at work.
class Setter {
 public:
  Setter(const SceneSource& source, const Parts& parts, std::size_t index)
      : source_(source), parts_(parts), line_(-static_cast<int>(index) - 1), text_(source.sets[index]) {}

  void apply(SceneValue& scene) {
    scene_ = &scene;
    if (!is_utf8(text_)) fail("this is not UTF-8; give text in that encoding");
    if (text_.starts_with(until_option)) {
      path_ = "integrator.until";
      return put(scene, SceneValue::of(text_.substr(until_option.size()), line_));
    }
    const std::size_t equals = text_.find('=');
    if (equals == std::string::npos || equals == 0) {
      fail("expected key=value, such as integrator.step=\"50 day\"");
    }
    path_ = text_.substr(0, equals);
    const std::string value = text_.substr(equals + 1);
    if (value.empty()) return take_out(scene);
    put(scene, parse_toml_value(value, line_).value_or(SceneValue::of(value, line_)));
  }

 private:
  void put(SceneValue& scene, SceneValue value) {
    const std::vector<std::string> keys = keys_of_path(path_);
    SceneValue& at = holder_of(scene, keys);
    if (SceneValue::Array* list = at.get<SceneValue::Array>()) return put_element(*list, keys.back(), std::move(value));
    if (keys.size() == 1) check_top(at, keys[0], value);
    if (keys.size() == 1) refuse_short_path(at, keys[0]);
    drop_alternatives(at, keys.back());
    at.put(keys.back(), std::move(value));
  }

  void take_out(SceneValue& scene) {
    const std::vector<std::string> keys = keys_of_path(path_);
    SceneValue& at = holder_of(scene, keys);
    const std::string& key = keys.back();
    if (SceneValue::Array* list = at.get<SceneValue::Array>()) {
      list->erase(list->begin() + (&element(*list, key) - list->data()));
      return;
    }
    if (at.find(key) == nullptr) {
      std::vector<std::string> written;
      for (const auto& [name, value] : *at.get<SceneValue::Table>()) add_new(written, name);
      fail(fmt::format("there is no '{}' to take out of the scene{}", key, elsewhere(did_you_mean(key, written))));
    }
    at.erase(key);
  }

  /// The table or the list of tables in which the last of the keys stands.
  SceneValue& holder_of(SceneValue& scene, const std::vector<std::string>& keys) {
    if (keys.size() > static_cast<std::size_t>(deepest_table)) {
      fail(fmt::format("the key has {} parts; at most {} are expected", keys.size(), deepest_table));
    }
    in_expect_ = keys[0] == "expect";
    SceneValue* at = &scene;
    for (std::size_t k = 0; k + 1 < keys.size(); ++k)
      at = &enter(*at, keys[k], k == 0, k == 1 && keys[0] == "hamiltonian");
    if (!at->is_table() && at->get<SceneValue::Array>() == nullptr)
      fail(fmt::format("'{}' is not a key of a table", path_));
    return *at;
  }

  [[noreturn]] void fail(const std::string& message) const { throw scene_error(source_, line_, path_, "", message); }

  /// One table of a list: `every.0={type="energy", steps=10}`; the number after the last adds one.
  void put_element(SceneValue::Array& list, const std::string& key, SceneValue value) {
    if (!value.is_table()) fail(fmt::format("'{}' is a table; set one of its keys: {}.key=value", path_, path_));
    if (key == std::to_string(list.size())) {
      list.push_back(std::move(value));
    } else {
      element(list, key) = std::move(value);
    }
  }

  void check_top(const SceneValue& scene, const std::string& key, const SceneValue& value) const {
    const SceneValue* old = scene.find(key);
    if (old == nullptr) return;
    if (old->is_table()) fail(fmt::format("'{}' is a table; set one of its keys: {}.key=value", key, key));
    if (old->is_table_list() && value.get<SceneValue::Array>() == nullptr) {
      fail(fmt::format("'{0}' is a list of tables; give a list, or set a key of one: {0}.0.key=value", key));
    }
  }

  /// A list of tables that the scene does not have has no element to set; the message tells what that means.
  void refuse_missing_list(const std::string& key) const {
    if (key == "every") {
      fail("the scene has no [[every]], so it is watched by default; write [[every]] tables to choose");
    }
    if (key == "stop") {
      fail("the scene has no [[stop]], so nothing but its end stops it; write [[stop]] tables to choose");
    }
    if (key == "verdict") fail("the scene has no [[verdict]]; write such a table to have runs judged");
    if (key == "minimize") fail("the scene has no [minimize], so it begins as it is; write that table to choose");
  }

  /// @param top  whether this is the scene itself  @param hamiltonian  whether it is its [hamiltonian]
  SceneValue& enter(SceneValue& at, const std::string& key, bool top, bool hamiltonian) {
    if (SceneValue::Array* list = at.get<SceneValue::Array>()) return element(*list, key);
    if (!at.is_table()) fail(fmt::format("there is nothing below the value {}", to_text(at)));
    if (SceneValue* next = at.find(key)) return *next;
    for (const std::string_view known : known_tables) {
      if (in_expect_ || (top && key == known)) return at.put(key, SceneValue::table(line_));
    }
    for (const std::string_view known : known_of_hamiltonian) {
      if (hamiltonian && key == known) return at.put(key, SceneValue::table(line_));
    }
    if (top) refuse_missing_list(key);
    std::vector<std::string> keys;
    for (const auto& [name, value] : *at.get<SceneValue::Table>()) {
      if (value.is_table() || value.is_table_list()) add_new(keys, name);
    }
    for (const std::string_view known : top_keys) {
      if (top) add_new(keys, known);
    }
    for (const std::string_view known : known_of_hamiltonian) {
      if (hamiltonian) add_new(keys, known);
    }
    fail(fmt::format("there is no '{}' in the scene{}", key, elsewhere(did_you_mean(key, keys))));
  }

  /// Refuses a key of a table that is given without its table: "step" instead of "integrator.step".
  void refuse_short_path(const SceneValue& scene, const std::string& key) const {
    if (scene.find(key) != nullptr || std::find(top_keys.begin(), top_keys.end(), key) != top_keys.end()) return;
    const std::string where = elsewhere("");
    if (!where.empty()) fail(fmt::format("unknown key '{}'{}", key, where));
  }

  /// The end of a message: whole paths that the one given may be the end of; `otherwise` where there is none.
  std::string elsewhere(const std::string& otherwise) const {
    constexpr std::size_t most = 3;
    const std::vector<std::string> meant = paths_meant(path_, key_paths(*scene_, parts_));
    if (meant.empty()) return otherwise;
    const std::size_t shown = std::min(meant.size(), most);
    std::string all = fmt::format("'{}'", meant[0]);
    for (std::size_t k = 1; k < shown; ++k) all += fmt::format("{}'{}'", k + 1 < shown ? ", " : " or ", meant[k]);
    return fmt::format("; did you mean {}{}?", all, shown < meant.size() ? ", among others" : "");
  }

  SceneValue& element(SceneValue::Array& list, const std::string& key) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
    if (error == std::errc() && end == key.data() + key.size()) {
      if (index >= list.size()) refuse_number(list, index, key);
      return list[index];
    }
    std::vector<SceneValue*> found;
    std::vector<std::string> names;
    for (SceneValue& one : list) {
      const std::string type = text_of(one, "type"), name = text_of(one, "name");
      if (type == key || name == key) found.push_back(&one);
      for (const std::string& known : {type, name}) add_new(names, known);
    }
    if (found.empty()) fail(fmt::format("there is no '{}' in the scene{}", key, did_you_mean(key, names)));
    if (found.size() > 1) {
      fail(fmt::format("'{}' appears {} times in the scene; give its number, counted from 0", key, found.size()));
    }
    return *found.front();
  }

  /// A number that a list does not have; the next one adds a table.
  [[noreturn]] void refuse_number(const SceneValue::Array& list, std::size_t index, const std::string& key) const {
    const std::string head = path_.substr(0, path_.find("." + key) + 1);
    const std::string there = list.empty()       ? "the list is empty"
                              : list.size() == 1 ? "the only one is number 0"
                                                 : fmt::format("the last one is number {}", list.size() - 1);
    const bool removes = text_.ends_with('=');
    fail(fmt::format("there is no element {}; {}{}", index, there,
                     removes ? "" : fmt::format(", and {}{}={{...}} adds one", head, list.size())));
  }

  static void drop_alternatives(SceneValue& table, const std::string& key) {
    for (const auto& group : alternatives) {
      bool member = false;
      for (const std::string_view one : group) member = member || one == key;
      if (!member) continue;
      for (const std::string_view one : group) {
        if (one != key) table.erase(one);
      }
    }
  }

  const SceneSource& source_;
  const Parts& parts_;
  const SceneValue* scene_ = nullptr;  ///< whole
  int line_;
  const std::string& text_;
  std::string path_;
  bool in_expect_ = false;  ///< where tables need not have been written
};

}  // namespace

void apply_sets(SceneValue& scene, const SceneSource& source, const Parts& parts) {
  for (std::size_t k = 0; k < source.sets.size(); ++k) Setter(source, parts, k).apply(scene);
}

}  // namespace noether

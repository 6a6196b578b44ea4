#pragma once
/// A scene as it was written: a tree of values that know their lines.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace noether {

/// One value of a scene file.
struct SceneValue {
  using Array = std::vector<SceneValue>;
  using Table = std::vector<std::pair<std::string, SceneValue>>;  ///< in the order of the file

  std::variant<bool, std::int64_t, double, std::string, Array, Table> data;
  int line = 0;  ///< of its key in the file; -k for the k-th `--set`, 0 where nobody wrote it

  SceneValue() : data(false) {}

  template <class T> static SceneValue of(T value, int line = 0) {
    SceneValue result;
    result.data = std::move(value);
    result.line = line;
    return result;
  }
  static SceneValue table(int line = 0) { return of(Table{}, line); }

  template <class T> const T* get() const { return std::get_if<T>(&data); }
  template <class T> T* get() { return std::get_if<T>(&data); }
  bool is_table() const { return get<Table>() != nullptr; }
  /// Whether it is a list of tables: `[[every]]`.
  bool is_table_list() const {
    const Array* list = get<Array>();
    return list != nullptr && !list->empty() && list->front().is_table();
  }

  /// The value of a key of this table; null if there is none, or this is no table.
  const SceneValue* find(std::string_view key) const {
    const Table* entries = get<Table>();
    if (entries == nullptr) return nullptr;
    for (const auto& [name, value] : *entries) {
      if (name == key) return &value;
    }
    return nullptr;
  }
  SceneValue* find(std::string_view key) {
    return const_cast<SceneValue*>(static_cast<const SceneValue*>(this)->find(key));
  }
  /// Appends an entry to this table, or replaces the one of that name.
  SceneValue& put(const std::string& key, SceneValue value) {
    if (SceneValue* old = find(key)) return *old = std::move(value);
    return std::get<Table>(data).emplace_back(key, std::move(value)).second;
  }
  /// Takes an entry out of this table, if it is there.
  void erase(std::string_view key) {
    Table& entries = std::get<Table>(data);
    for (auto at = entries.begin(); at != entries.end(); ++at) {
      if (at->first != key) continue;
      entries.erase(at);
      return;
    }
  }
};

/// What a value is, in words with an article: "a number", "a text", "a table".
std::string_view kind_of(const SceneValue& value);

/// One value as a scene shows it, on one line: `"100 day"`, `[1, 2, 3]`.
std::string to_text(const SceneValue& value);

}  // namespace noether

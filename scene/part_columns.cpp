#include "scene/part_columns.hpp"

#include <algorithm>
#include <string>

namespace noether {

namespace {

auto column_named(const std::string& name) {
  return [&name](const ColumnInfo& column) { return column.name == name; };
}

}  // namespace

std::vector<ColumnInfo> declared_columns(const SceneContext& context, const Parts& parts,
                                         const SceneValue& hamiltonian) {
  std::vector<ColumnInfo> all;
  const auto take = [&](const SceneValue& table, const auto& kinds) {
    const SceneValue* type = table.find("type");
    const std::string* name = type != nullptr ? type->get<std::string>() : nullptr;
    for (const auto& kind : kinds) {
      if (name == nullptr || kind.info.name != *name) continue;
      for (const ColumnInfo& column : kind.columns) {
        const auto other = std::find_if(all.begin(), all.end(), column_named(column.name));
        if (other == all.end()) {
          all.push_back(column);
          continue;
        }
        try {
          expect_same_meaning(*other, column);
        } catch (const Error& error) {
          TableReader(context, table, *name, "hamiltonian").fail("type", error.message());
        }
      }
    }
  };
  take(hamiltonian, parts.hamiltonians());
  for (const char* key : {"force", "field"}) {
    const SceneValue* forces = hamiltonian.find(key);
    const auto* list = forces != nullptr ? forces->get<SceneValue::Array>() : nullptr;
    for (std::size_t k = 0; list != nullptr && k < list->size(); ++k) take((*list)[k], parts.forces());
  }
  return all;
}

std::vector<ColumnInfo> columns_of_other_parts(const Parts& parts, const std::vector<ColumnInfo>& declared) {
  std::vector<ColumnInfo> all;
  const auto take = [&](const auto& kinds) {
    for (const auto& kind : kinds) {
      for (const ColumnInfo& column : kind.columns) {
        const auto is_in = [&](const auto& list) {
          return std::any_of(list.begin(), list.end(), column_named(column.name));
        };
        if (!is_in(declared) && !is_in(all)) all.push_back(column);
      }
    }
  };
  take(parts.hamiltonians());
  take(parts.forces());
  return all;
}

}  // namespace noether

#include "cli/describe_all.hpp"

#include "cli/described_parts.hpp"
#include "cli/scene_tables.hpp"
#include "scene/read_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace noether {

namespace {

/// Kinds of parts in the order of the page, with their headings.
constexpr std::array<std::pair<std::string_view, std::string_view>, 12> headings = {{
    {"hamiltonian", "Hamiltonians"},
    {"force", "Forces"},
    {"field", "Fields"},
    {"thermostat", "Thermostats"},
    {"constraint", "Constraints"},
    {"system", "Systems"},
    {"builder", "Builders"},
    {"start", "Before the first step"},
    {"decorator", "Decorators"},
    {"monitor", "Monitors"},
    {"writer", "Writers"},
    {"stop", "Stops"},
}};

/// A text as a cell of a table.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c == '\n' ? ' ' : c;
  }
  return escaped;
}

std::string default_of(const FieldInfo& field) {
  if (!field.example.empty()) return "required, such as `" + field.example + "`";
  return field.default_value.empty() ? "" : "`" + field.default_value + "`";
}

std::string capitalized(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

/// The keys of one table or part.
void print_keys(const std::vector<FieldInfo>& fields) {
  if (fields.empty()) return;
  fmt::print("\n| key | type | dimension | default | meaning |\n|---|---|---|---|---|\n");
  for (const FieldInfo& field : fields) {
    const std::string choices =
        field.choices.empty() ? ""
                              : fmt::format("{}`{}`", field.help.empty() ? "" : "; ", fmt::join(field.choices, "`, `"));
    fmt::print("| `{}` | {} | {} | {} | {} |\n", field.name, field.kind, field.dimension == "1" ? "" : field.dimension,
               cell(default_of(field)), cell(field.help + choices));
  }
}

void print_part(const std::string& kind, const PartInfo& info) {
  fmt::print("\n### `{}`\n\n{}.\n", info.name, capitalized(info.help));
  if (!info.formula.empty()) fmt::print("\n    {}\n", info.formula);
  if (!info.quantities.empty()) fmt::print("\nQuantities: {}.\n", info.quantities);
  if (info.fields.empty() && kind != "hamiltonian") fmt::print("\nIt has no keys of its own.\n");
  print_keys(info.fields);
  if (!info.columns.empty()) fmt::print("\nBodies take {}.\n", fmt::join(texts_of(info.columns, "`"), ", "));
}

/// Which keys each method takes beside those of all methods, methods with the same keys together.
void print_methods(const Parts& parts) {
  fmt::print(
      "\n## Methods\n\nEvery method takes the keys of `[integrator]` down to `exact`. Splitting schemes take "
      "`compensated`, `corrector`, `kernel` and\n`second_corrector` too, `respa` `inner_steps`, classical methods "
      "these; `noether describe "
      "METHOD` has the defaults of each, and "
      "[methods.md](methods.md) its measured order and cost.\n\n| keys | methods |\n|---|---|\n");
  std::vector<std::pair<std::string, std::vector<std::string>>> rows;
  for (const MethodInfo* info : parts.methods()) {
    std::string keys;
    for (const FieldInfo& field : fields_of(*info)) keys += fmt::format("{}`{}`", keys.empty() ? "" : ", ", field.name);
    const auto same = [&](const auto& row) { return row.first == keys; };
    auto row = std::find_if(rows.begin(), rows.end(), same);
    if (row == rows.end()) row = rows.insert(rows.end(), {keys, {}});
    row->second.push_back(fmt::format("`{}`", info->name));
  }
  for (const auto& [keys, methods] : rows) {
    fmt::print("| {} | {} |\n", keys.empty() ? "none" : keys, fmt::join(methods, ", "));
  }
}

void print_page(const Parts& parts) {
  fmt::print(
      "# The keys of a scene\n\n"
      "Written by `./noether describe --all > docs/keys.md` (with `--json`: the same for programs). It has every "
      "table, "
      "every part and\nevery key that a scene may have. [scenes.md](scenes.md) is the tutorial; `noether describe "
      "NAME` "
      "shows one part with its sources.\n\n"
      "A key with a dimension takes a number and a unit in quotes, `\"100 day\"`, in the reduced system a bare number; "
      "defaults "
      "with one stand\nin the units of the scene. `noether list units` has all units. Unknown keys are refused, "
      "with "
      "a proposal.\n\n"
      "# Tables\n");
  for (const SceneTable& table : scene_tables(parts)) {
    fmt::print("\n## {}\n\n{}\n", table.name.empty() ? "Above all tables" : "`" + table.name + "`", table.help);
    print_keys(table.fields);
  }
  fmt::print("\n# Parts\n\nWhat a table takes beside the keys above, by its `type`.\n");
  const auto all = described_parts(parts);
  for (const auto& [kind, heading] : headings) {
    const auto is_of_kind = [&, wanted = kind](const auto& part) { return part.first == wanted; };
    if (std::none_of(all.begin(), all.end(), is_of_kind)) continue;
    fmt::print("\n## {}\n\nIn {}.\n", heading,
               table_of(std::string(kind)).empty() ? "[hamiltonian]" : table_of(std::string(kind)));
    for (const auto& part : all) {
      if (is_of_kind(part)) print_part(part.first, part.second);
    }
  }
  print_methods(parts);
}

void print_json(const Parts& parts) {
  std::vector<Json> tables, all, methods;
  for (const SceneTable& table : scene_tables(parts)) {
    tables.push_back(Json::object({{"name", table.name}, {"help", table.help}, {"fields", json_of(table.fields)}}));
  }
  for (const auto& [kind, info] : described_parts(parts)) {
    all.push_back(Json::object({{"kind", kind},
                                {"name", info.name},
                                {"help", info.help},
                                {"formula", info.formula},
                                {"quantities", info.quantities},
                                {"table", table_of(kind)},
                                {"fields", json_of(info.fields)},
                                {"columns", json_of(info.columns)}}));
  }
  for (const MethodInfo* info : parts.methods()) {
    methods.push_back(Json::object({{"name", info->name}, {"fields", json_of(fields_of(*info))}}));
  }
  fmt::print("{}\n", Json::object({{"schema", "noether.keys/1"},
                                   {"tables", Json::list(tables)},
                                   {"parts", Json::list(all)},
                                   {"methods", Json::list(methods)}})
                         .text());
}

}  // namespace

void describe_all(const Parts& parts, bool json) {
  if (json) {
    print_json(parts);
  } else {
    print_page(parts);
  }
}

}  // namespace noether

#include "scene/read_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>
#include <utility>

namespace noether {

namespace {

SceneValue value_of(const OptionValue& option, const UnitSystem& units) {
  return std::visit(
      [&](const auto& value) {
        using V = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_same_v<V, double>) return detail::quantity_value(value, option.dimension, units);
        if constexpr (!std::is_same_v<V, std::monostate> && !std::is_same_v<V, double>) return SceneValue::of(value);
        return SceneValue();
      },
      option.value);
}

std::vector<std::string> choices_of(const OptionValue& option) {
  return {option.choices.begin(), option.choices.end()};
}

OptionValue::Value read_option(TableReader& reader, const OptionValue& option) {
  const std::string_view key = option.name;
  if (option.kind == "flag") return reader.flag(key, false);
  if (option.kind == "whole number") return *reader.integer(key);
  if (option.kind == "number") return *reader.quantity(key, option.dimension);
  std::string text = reader.text(key);
  const std::vector<std::string> choices = choices_of(option);
  if (option.kind == "choice" && std::find(choices.begin(), choices.end(), text) == choices.end()) {
    reader.fail(key, fmt::format("unknown {} '{}'{}", key, text, did_you_mean(text, choices)));
  }
  return text;
}

}  // namespace

std::vector<FieldInfo> fields_of(const MethodInfo& info) {
  std::vector<FieldInfo> fields;
  const MethodOptions defaults = info.resolved({});
  for (const OptionGroup* group : info.option_groups()) {
    for (const OptionValue& one : group->values(defaults)) {
      if (group == error_control && one.name == "adaptive" && !info.fixed) continue;
      const std::string known = one.value.index() == 0 ? "" : to_text(value_of(one, unit_system("reduced")));
      fields.push_back({std::string(one.name), std::string(one.dimension), std::string(one.help), std::string(one.kind),
                        known, "", choices_of(one)});
    }
  }
  return fields;
}

void read_options(TableReader& reader, const OptionGroup& group, MethodOptions& options) {
  for (const OptionValue& one : group.values(options)) {
    if (reader.has(one.name)) group.set(options, one.name, read_option(reader, one));
  }
}

void put_options(TableReader& reader, const OptionGroup& group, const MethodOptions& options, SceneValue& effective) {
  for (const OptionValue& one : group.values(options)) {
    if (one.value.index() == 0) continue;
    const SceneValue* written = reader.find(one.name);
    effective.put(std::string(one.name), written != nullptr ? *written : value_of(one, *reader.context().units));
  }
}

}  // namespace noether

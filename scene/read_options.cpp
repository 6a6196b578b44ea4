#include "scene/read_options.hpp"

#include "numbers/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>
#include <utility>

namespace noether {

namespace {

SceneValue value_of(const OptionValue& option, const UnitSystem& units) {
  return std::visit(
      [&](const auto& value) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, std::monostate>) {
          return SceneValue();
        } else {
          return detail::field_value(value, option.dimension, units);
        }
      },
      option.value);
}

std::vector<std::string> choices_of(const OptionValue& option) {
  return {option.choices.begin(), option.choices.end()};
}

/// The texts of a list, one at least. A text alone is a list of its words, parted by commas, as older scenes have it.
std::vector<std::string> read_texts(TableReader& reader, std::string_view key) {
  const SceneValue& value = *reader.find(key);
  std::vector<std::string> texts;
  if (const std::string* words = value.get<std::string>()) {
    std::string spaced = *words;
    std::replace(spaced.begin(), spaced.end(), ',', ' ');
    texts = words_of(spaced);
  } else {
    detail::read_field(reader, key, "1", texts);
  }
  if (texts.empty()) reader.fail(key, fmt::format("{} = {} is empty; give one text or more", key, to_text(value)));
  return texts;
}

OptionValue::Value read_option(TableReader& reader, const OptionValue& option) {
  const std::string_view key = option.name;
  if (option.kind == "flag") return reader.flag(key, false);
  if (option.kind == "whole number") return *reader.integer(key);
  if (option.kind == "number") return *reader.quantity(key, option.dimension);
  if (option.kind == "list") return read_texts(reader, key);
  std::string text = reader.text(key);
  const std::vector<std::string> choices = choices_of(option);
  if (option.kind == "choice" && std::find(choices.begin(), choices.end(), text) == choices.end()) {
    reader.fail(key, fmt::format("unknown {} '{}'{}", key, text, did_you_mean(text, choices)));
  }
  return text;
}

}  // namespace

CompositionOptions read_composition(TableReader& reader) {
  CompositionOptions options;
  try {
    read_fields(reader, options);
  } catch (const SceneError&) {
    throw;
  } catch (const Error& error) {
    reader.refuse(error);
  }
  return options;
}

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

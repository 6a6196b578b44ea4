#include "scene/fields.hpp"

#include "numbers/quantity.hpp"
#include "numbers/text.hpp"
#include "scene/foreign_names.hpp"

namespace noether::detail {

SceneValue quantity_value(double value, std::string_view dimension, const UnitSystem& units) {
  const Dimension parsed = parse_dimension(dimension);
  if (units.is_reduced() || parsed == dimensions::none) {
    if (dimension != "angle" || units.is_reduced()) return SceneValue::of(value);
    return SceneValue::of(format_number(value) + " rad");
  }
  const std::string unit = unit_of(parsed, units);
  // "0 1/day" is no quantity; "0/day" is.
  const bool inverse = unit.starts_with("1/");
  return SceneValue::of(format_number(value) + (inverse ? unit.substr(1) : " " + unit));
}

PartInfo part_texts(std::string_view name, std::string_view help, std::string_view formula, std::string_view source,
                    std::string_view quantities) {
  return {std::string(name), std::string(help), std::string(formula), std::string(source), std::string(quantities), {}};
}

void add_field(PartInfo& info, const FieldTexts& texts, std::string_view kind, const SceneValue* value,
               std::vector<std::string> choices) {
  const bool has_default = value != nullptr && texts.example.empty();
  info.fields.push_back({std::string(texts.name), std::string(texts.dimension), std::string(texts.help),
                         std::string(kind), has_default ? to_text(*value) : "", std::string(texts.example),
                         std::move(choices)});
}

std::string who_knows(const SceneContext& context, const std::string& type, const std::vector<std::string>& known) {
  if (context.program.empty()) return proposal(type, known);
  const std::string near = proposal(type, known, "");
  return near + fmt::format("{} the program of this scene has more parts: run `{}`",
                            near.ends_with('?') ? " If not," : ";", context.program);
}

void require_field(TableReader& reader, const FieldTexts& texts) {
  if (texts.example.empty() || reader.has(texts.name)) return;
  const bool bare = reader.context().units->is_reduced();
  reader.fail(nullptr, texts.name,
              fmt::format("{} has no {}; give one{}{}", reader.what(), texts.name, bare ? "" : ", such as ",
                          bare ? "" : texts.example));
}

}  // namespace noether::detail

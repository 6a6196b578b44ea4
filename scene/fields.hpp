#pragma once
/// Fields of a part, read from a scene as the part's own description tells.

#include "engine/columns.hpp"
#include "engine/description.hpp"
#include "numbers/suggest.hpp"
#include "scene/foreign_names.hpp"
#include "scene/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace noether {

/// One field as `noether describe` shows it.
struct FieldInfo {
  std::string name, dimension, help;
  std::string kind;           ///< number, whole number, flag, text, vector, list, choice
  std::string default_value;  ///< as a scene writes it in the reduced system; empty: none
  std::string example;        ///< not empty: a scene must give the field, such as this
  std::vector<std::string> choices;
};

/// A part as `noether list` and `noether describe` show it.
struct PartInfo {
  std::string name, help, formula, source, quantities;
  std::vector<FieldInfo> fields = {};
  std::vector<std::pair<char, std::string>> letters = {};  ///< what it gives to words, and what their flows are
  std::vector<ColumnInfo> columns = {};                    ///< keys that bodies have because of it

  /// What the flow of a letter is, in words; empty: it has no such letter.
  std::string meaning(char letter) const {
    for (const auto& [one, text] : letters) {
      if (one == letter) return text;
    }
    return "";
  }
};

namespace detail {

/// A default in the units of a scene, as text that reads back to the same bits.
SceneValue quantity_value(double value, std::string_view dimension, const UnitSystem& units);

template <class E> std::vector<std::string> choice_names() {
  std::vector<std::string> names;
  for (const auto& [value, name] : EnumNames<E>::values) names.emplace_back(name);
  return names;
}

/// A value of a field as a scene writes it.
template <class V> SceneValue field_value(const V& value, std::string_view dimension, const UnitSystem& units) {
  if constexpr (std::is_same_v<V, bool>) {
    return SceneValue::of(value);
  } else if constexpr (std::is_integral_v<V>) {
    return SceneValue::of(static_cast<std::int64_t>(value));
  } else if constexpr (std::is_floating_point_v<V>) {
    return quantity_value(value, dimension, units);
  } else if constexpr (std::is_enum_v<V>) {
    for (const auto& [known, name] : EnumNames<V>::values) {
      if (known == value) return SceneValue::of(std::string(name));
    }
    return SceneValue::of(std::string());
  } else if constexpr (std::is_same_v<V, std::string>) {
    return SceneValue::of(value);
  } else {
    SceneValue::Array list;
    for (const auto& element : value) list.push_back(field_value(element, dimension, units));
    return SceneValue::of(std::move(list));
  }
}

/// The value of that name. @throws SceneError  if there is none
template <class E> E choice_of(const TableReader& reader, const std::string& text, std::string_view key) {
  for (const auto& [value, name] : EnumNames<E>::values) {
    if (name == text) return value;
  }
  reader.fail(key,
              fmt::format("unknown {} '{}' in {}{}", key, text, reader.what(), did_you_mean(text, choice_names<E>())));
}

template <class V>
V read_element(const TableReader& reader, const SceneValue& value, std::string_view key, std::string_view dimension) {
  if constexpr (std::is_enum_v<V>) {
    const std::string* text = value.get<std::string>();
    if (text == nullptr) reader.wrong_kind(value, key, "a list of texts");
    return choice_of<V>(reader, *text, key);
  } else if constexpr (std::is_same_v<V, std::string>) {
    const std::string* text = value.get<std::string>();
    if (text == nullptr) reader.wrong_kind(value, key, "a list of texts");
    return *text;
  } else if constexpr (std::is_integral_v<V>) {
    const std::int64_t* whole = value.get<std::int64_t>();
    if (whole == nullptr) reader.wrong_kind(value, key, "a list of whole numbers");
    return static_cast<V>(*whole);
  } else if constexpr (requires { typename V::value_type; }) {
    const auto* list = value.get<SceneValue::Array>();
    if (list == nullptr) reader.wrong_kind(value, key, "a list of lists");
    V elements;
    for (const SceneValue& one : *list) {
      elements.push_back(read_element<typename V::value_type>(reader, one, key, dimension));
    }
    return elements;
  } else {
    return static_cast<V>(reader.number(value, key, dimension));
  }
}

template <class E> E read_choice(TableReader& reader, std::string_view key) {
  const SceneValue* given = reader.find(key);  // "2" or 2
  const bool whole = given != nullptr && given->template get<std::int64_t>() != nullptr;
  return choice_of<E>(reader, whole ? to_text(*given) : reader.text(key), key);
}

/// Whether a field is the angular velocity of a turning frame, which the Hamiltonian tells once.
inline bool is_rate_of_frame(std::string_view key, std::string_view dimension) {
  return key == "Omega" && dimension == "1/time";
}

/// Reads one field where the scene gives it.
template <class V> void read_field(TableReader& reader, std::string_view key, std::string_view dimension, V& target) {
  using T = typename optional_value<V>::type;
  const SceneValue* value = reader.find(key);
  if (value == nullptr) {
    // G and Omega of the Hamiltonian are the defaults of every field of that name.
    if constexpr (std::is_same_v<V, std::optional<double>>) {
      if (key == "G" && reader.context().G) target = reader.number(*reader.context().G, "G", dimension);
      if (is_rate_of_frame(key, dimension) && reader.context().Omega)
        target = reader.number(*reader.context().Omega, key, dimension);
    }
  } else if constexpr (std::is_same_v<T, bool>) {
    target = reader.flag(key, false);
  } else if constexpr (std::is_integral_v<T>) {
    target = static_cast<T>(*reader.integer(key));
  } else if constexpr (std::is_floating_point_v<T>) {
    target = *reader.quantity(key, dimension);
    if constexpr (std::is_same_v<V, std::optional<double>>) {
      if (key == "G") reader.expect_same_constant(*target);
      if (is_rate_of_frame(key, dimension)) reader.expect_same_rate(*target);
    }
  } else if constexpr (std::is_enum_v<T>) {
    target = read_choice<T>(reader, key);
  } else if constexpr (std::is_same_v<T, std::string>) {
    target = reader.text(key);
  } else if constexpr (std::is_same_v<T, std::array<double, 3>>) {
    target = *reader.vector(key, dimension);
  } else {
    const auto* list = value->template get<SceneValue::Array>();
    if (list == nullptr) reader.wrong_kind(*value, key, "a list");
    T elements;
    for (const SceneValue& one : *list) {
      elements.push_back(read_element<typename T::value_type>(reader, one, key, dimension));
    }
    target = std::move(elements);
  }
}

}  // namespace detail

namespace detail {

PartInfo part_texts(std::string_view name, std::string_view help, std::string_view formula, std::string_view source,
                    std::string_view quantities);

/// Texts of a field, whatever its type.
struct FieldTexts {
  std::string_view name, dimension, help, example;

  template <class F> static FieldTexts of(const F& field) {
    return {field.name, field.dimension, field.help, field.example};
  }
};

/// Appends what is known of a field. @param value  its default; null: none
void add_field(PartInfo& info, const FieldTexts& texts, std::string_view kind, const SceneValue* value,
               std::vector<std::string> choices);
/// Refuses a table without a field that has no default. @throws SceneError
void require_field(TableReader& reader, const FieldTexts& texts);

/// The same for a field of type `V`: compiled for each type once, not for each field.
template <class V> void add_field(PartInfo& info, const FieldTexts& texts, const V& value) {
  using Plain = typename optional_value<V>::type;
  std::vector<std::string> choices;
  if constexpr (std::is_enum_v<Plain>) {
    choices = choice_names<Plain>();
  } else if constexpr (requires { EnumNames<typename Plain::value_type>::values; }) {
    choices = choice_names<typename Plain::value_type>();
  }
  std::optional<SceneValue> known;
  if constexpr (std::is_same_v<V, Plain>) {
    known = field_value(value, "1", unit_system("reduced"));
  } else if (value) {
    known = field_value(*value, "1", unit_system("reduced"));
  }
  add_field(info, texts, field_kind<V>(), known ? &*known : nullptr, std::move(choices));
}

/// Appends a field as it is: what the scene wrote, or the value in the units of the scene.
template <class V>
void put_field(TableReader& reader, std::string_view name, std::string_view dimension, const V& value,
               SceneValue& effective) {
  if (const SceneValue* written = reader.find(name)) {
    effective.put(std::string(name), *written);
  } else if constexpr (std::is_same_v<V, typename optional_value<V>::type>) {
    effective.put(std::string(name), field_value(value, dimension, *reader.context().units));
  } else if (value && name != "G" && !is_rate_of_frame(name, dimension)) {
    effective.put(std::string(name), field_value(*value, dimension, *reader.context().units));
  }
}

}  // namespace detail

/// What part `T` says of itself.
template <class T> PartInfo part_info() {
  constexpr std::string_view formula = entry_text<T, Formula>(), source = entry_text<T, Source>(),
                             quantities = entry_text<T, Quantities>();
  constexpr auto& description = detail::description_of<T>;
  PartInfo info = detail::part_texts(description.name, description.help, formula, source, quantities);
  if constexpr (std::is_default_constructible_v<T>) {
    const T defaults{};
    for_each_field<T>(
        [&](const auto& field) { detail::add_field(info, detail::FieldTexts::of(field), defaults.*(field.member)); });
  }
  for_each_letter<T>([&](const Letter& one) { info.letters.emplace_back(one.letter, std::string(one.text)); });
  info.columns = columns_of<T>();
  return info;
}

/// Reads every field of a part that the table gives; the others keep their defaults.
template <class T> void read_fields(TableReader& reader, T& part) {
  for_each_field<T>(
      [&](const auto& field) { detail::read_field(reader, field.name, field.dimension, part.*(field.member)); });
}

namespace detail {
/// Refuses missing fields, and what the part itself refuses. @throws SceneError  at the line of the key
template <class T> void check_fields(TableReader& reader, const T& part) {
  for_each_field<T>([&](const auto& field) { require_field(reader, FieldTexts::of(field)); });
  try {
    check_part(part);
  } catch (const SceneError&) {
    throw;
  } catch (const Error& error) {
    reader.refuse(error);
  }
}
}  // namespace detail

/// Reads every field of a part, then refuses unknown keys, missing fields, and what the part itself refuses.
///
/// Keys of the table that are no fields of the part must have been asked for before.
/// @throws SceneError  at the line of the key
template <class T> void read_part(TableReader& reader, T& part) {
  read_fields(reader, part);
  reader.finish();
  detail::check_fields(reader, part);
}

/// Appends every field of a part as it is: what the scene wrote, and defaults in the units of the scene.
template <class T> void put_fields(TableReader& reader, const T& part, SceneValue& effective) {
  for_each_field<T>([&](const auto& field) {
    detail::put_field(reader, field.name, field.dimension, part.*(field.member), effective);
  });
}

template <class Kinds> std::vector<std::string> names_of(const Kinds& kinds) {
  std::vector<std::string> names;
  for (const auto& kind : kinds) names.push_back(kind.info.name);
  return names;
}

namespace detail {
/// What to do about a part that nobody knows: the name that was meant, the program of the scene, or those there are.
std::string who_knows(const SceneContext& context, const std::string& type, const std::vector<std::string>& known);
}  // namespace detail

/// The kind a table names in its `type`, and that type; no kind for one of the names in `others`.
/// @throws SceneError  for a type that nobody knows
template <class Kind>
std::pair<const Kind*, std::string> kind_of_part(const SceneContext& context, const SceneValue& table,
                                                 const std::string& path, const std::string& what,
                                                 const std::vector<Kind>& kinds,
                                                 const std::vector<std::string>& others) {
  const std::size_t dot = path.rfind('.');  // the number of a table in its list
  const std::string name = dot == std::string::npos ? "[" + path + "]" : "[[" + path.substr(0, dot) + "]]";
  TableReader reader(context, table, name, path);
  const std::string type = reader.text("type");
  for (const Kind& kind : kinds) {
    if (kind.info.name == type) return {&kind, type};
  }
  if (std::find(others.begin(), others.end(), type) != others.end()) return {nullptr, type};
  std::vector<std::string> known = names_of(kinds);
  known.insert(known.end(), others.begin(), others.end());
  if (!reader.has("type")) {
    reader.fail(nullptr, "type", fmt::format("this {} has no type; expected one of: {}", what, fmt::join(known, ", ")));
  }
  reader.fail("type", fmt::format("unknown {} '{}'{}", what, type, detail::who_knows(context, type, known)));
}

}  // namespace noether

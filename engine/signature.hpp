#pragma once
/// What a part was made with, in text: a saved run goes on with the same parts and parameters only.

#include "engine/description.hpp"
#include "numbers/error.hpp"
#include "numbers/types.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace noether::detail {

template <class T> std::string name_of(const T& value) {
  if constexpr (requires { std::string(value.name()); }) {
    return std::string(value.name());
  } else {
    return std::string(part_name<T>());
  }
}

std::string value_text(double x);
std::string value_text(std::int64_t x);
std::string value_text(const std::optional<double>& x);
std::string value_text(const Vec3<double>& x);
std::string value_text(const std::array<double, 3>& x);
std::string value_text(const std::optional<std::array<double, 3>>& x);
template <class T> std::string value_text(const T& value) {
  if constexpr (std::is_enum_v<T> || std::is_integral_v<T>) {
    return value_text(static_cast<std::int64_t>(value));
  } else {
    return "?";
  }
}

/// Appends ", name = value"; the first without the comma.
void add_field_text(std::string& fields, std::string_view name, const std::string& value);

/// A part and its parameters, "gravity(G = default, softening = 0)": two parts that differ in it make different runs.
template <class T> std::string signature_of(const T& value) {
  if constexpr (requires { std::string(value.signature()); }) {
    return value.signature();
  } else if constexpr (requires { T::describe(); }) {
    std::string fields;
    for_each_field<T>([&](const auto& field) {
      const auto& given = value.*(field.member);
      using Plain = typename optional_value<std::decay_t<decltype(given)>>::type;
      constexpr bool may_lack = !std::is_same_v<Plain, std::decay_t<decltype(given)>>;
      if constexpr (std::is_enum_v<Plain> && may_lack) {
        if (given) add_field_text(fields, field.name, value_text(*given));  // runs from before there was a choice go on
      } else if constexpr (std::is_same_v<Plain, std::string> && may_lack) {
        if (given) add_field_text(fields, field.name, *given);
      } else {
        add_field_text(fields, field.name, value_text(given));
      }
    });
    if constexpr (requires { value.tied.front()[0]; }) {
      fields += fields.empty() ? "tied = [" : ", tied = [";
      for (const auto& particles : value.tied) fields += fmt::format("[{}]", fmt::join(particles, " "));
      fields += "]";
    }
    return fmt::format("{}({})", part_name<T>(), fields);
  } else {
    return name_of(value);
  }
}

/// Notes with what a part was made, so that a saved run is not continued by another.
template <class T> void save_signature(SavedState& saved, const std::string& prefix, const T& value) {
  save_value(saved, prefix + "signature", signature_of(value));
}
/// @throws Error  if the saved run was made with other parts or parameters
template <class T> void check_signature(const SavedState& saved, const std::string& prefix, const T& value) {
  std::string before;
  load_value(saved, prefix + "signature", before);
  const std::string now = signature_of(value);
  if (before != now) {
    throw Error(fmt::format("the saved run was made with {}, but this one has {}", before, now));
  }
}

}  // namespace noether::detail

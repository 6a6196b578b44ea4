#pragma once
/// The parameters of a constraint as bits, to tell which constraints are equal.

#include "engine/description.hpp"
#include "numbers/types.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>

namespace noether::detail {

/// Whether the bits of a T are all there is to tell: numbers, and optional ones and arrays of them.
template <class T>
inline constexpr bool tells_by_bits = std::is_same_v<T, double> || std::is_integral_v<T> || std::is_enum_v<T>;
template <class T> inline constexpr bool tells_by_bits<std::optional<T>> = tells_by_bits<T>;
template <class T, std::size_t n> inline constexpr bool tells_by_bits<std::array<T, n>> = tells_by_bits<T>;
template <> inline constexpr bool tells_by_bits<Vec3<double>> = true;

template <class T, std::size_t n> void append_bits(std::string& bits, const std::array<T, n>& values);
template <class T> void append_bits(std::string& bits, const T& value) {
  bits.append(reinterpret_cast<const char*>(&value), sizeof value);
}
template <class T> void append_bits(std::string& bits, const std::optional<T>& value) {
  bits += value ? '1' : '0';
  if (value) append_bits(bits, *value);
}
template <class T, std::size_t n> void append_bits(std::string& bits, const std::array<T, n>& values) {
  for (const T& value : values) append_bits(bits, value);
}

/// Whether the fields that a part describes are all that it consists of, and their bits tell what they are: they leave
/// no room for another member.
template <class C> constexpr bool described_by_bits() {
  std::size_t bytes = 0;
  bool all = true;
  for_each_field<C>([&]<auto Member>(const Field<Member>&) {
    using Value = typename Field<Member>::value_type;
    bytes += sizeof(Value);
    all = all && tells_by_bits<Value>;
  });
  return all && bytes == sizeof(C);
}

/// The bits of a constraint's parameters. Of one that does not describe all of them nobody knows when it is equal to
/// another: its number stands for them.
template <class C> std::string parameter_bits(const C& constraint, Index number) {
  std::string bits;
  if constexpr (std::is_empty_v<C>) {
    return bits;
  } else if constexpr (Described<C>) {
    if constexpr (described_by_bits<C>()) {
      for_each_field<C>([&](const auto& field) { append_bits(bits, constraint.*(field.member)); });
      return bits;
    }
  }
  append_bits(bits, number);
  return bits;
}

}  // namespace noether::detail

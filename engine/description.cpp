#include "engine/description.hpp"

#include "numbers/quantity.hpp"

#include <fmt/format.h>

#include <array>

namespace noether {

void refuse_field(std::string_view key, const std::string& value, const std::string& why) {
  throw Error(fmt::format("{} = {} {}", key, value, why), {.key = std::string(key), .value = value});
}

void refuse_field(std::string_view key, double value, const std::string& why) {
  refuse_field(key, format_number(value), why);
}

void refuse_field(std::string_view key, const std::array<double, 3>& value, const std::string& why) {
  refuse_field(
      key, fmt::format("[{}, {}, {}]", format_number(value[0]), format_number(value[1]), format_number(value[2])), why);
}

void check_constant_of_gravitation(const std::optional<double>& G) {
  if (G && !(*G > 0)) refuse_field("G", *G, "is not a valid gravitational constant; a number above 0 is expected");
}

namespace detail {

std::string key_below(const std::string& prefix, std::string_view name) {
  return prefix.empty() ? std::string(name) : fmt::format("{}/{}", prefix, name);
}

}  // namespace detail

}  // namespace noether

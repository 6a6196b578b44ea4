#include "engine/columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>

namespace noether {

namespace {

/// "a configuration of 4 numbers in [1] that start at 1 0 0 0"
std::string meaning(const ColumnInfo& info) {
  constexpr std::array<std::string_view, 3> roles = {"a parameter", "a configuration", "a momentum"};
  const std::span<const double> start(info.start.data(), static_cast<std::size_t>(info.width));
  return fmt::format("{} of {} {} in [{}] that start at {}", roles[static_cast<std::size_t>(info.role)], info.width,
                     info.width == 1 ? "number" : "numbers", info.dimension, fmt::join(start, " "));
}

}  // namespace

void expect_same_meaning(const ColumnInfo& one, const ColumnInfo& other) {
  if (one == other) return;
  throw Error(fmt::format("column '{}' is declared twice, as {} and as {}; give one of them another name", one.name,
                          meaning(one), meaning(other)));
}

}  // namespace noether

#pragma once
/// How often faster kicks step in one step of slower ones.

#include "engine/description.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace noether {

/// Multiple time steps by forces of several kicks, those of B the fastest: so many steps of B in one of the next
/// letter, so many of that in one of the one after it, and so on.
class InnerSteps {
 public:
  using value_type = std::int64_t;
  static constexpr std::size_t most_levels = 3;
  static constexpr std::int64_t most_steps = 1000;  ///< of the fastest kicks in one of the slowest

  constexpr InnerSteps() = default;
  /// @throws Error  as `push_back`
  InnerSteps(std::initializer_list<std::int64_t> counts) {
    for (const std::int64_t count : counts) push_back(count);
  }

  /// @throws Error  for a number that is not one of steps, for too many levels, and too many steps in all
  void push_back(std::int64_t count) {
    if (count < 1) {
      refuse_field("inner_steps", std::to_string(count),
                   "is not a valid number of steps; 1 or more of each level are expected");
    }
    if (size() == most_levels) {
      refuse_field("inner_steps", text() + " and more",
                   "is too long a list; at most 3 numbers, for kicks of 4 letters, are expected");
    }
    if (count > most_steps / all()) {
      refuse_field("inner_steps", std::to_string(count),
                   "are too many steps of the fastest forces in one of the slowest; at most 1000 are expected");
    }
    counts_[size()] = static_cast<std::uint16_t>(count);
  }

  constexpr std::size_t size() const {
    std::size_t levels = 0;
    while (levels < most_levels && counts_[levels] != 0) ++levels;
    return levels;
  }
  constexpr bool empty() const { return size() == 0; }
  constexpr const std::uint16_t* begin() const { return counts_.data(); }
  constexpr const std::uint16_t* end() const { return counts_.data() + size(); }
  constexpr bool operator==(const InnerSteps&) const = default;

  /// Steps of the fastest kicks in one of the slowest.
  constexpr std::int64_t all() const {
    std::int64_t product = 1;
    for (const std::uint16_t count : *this) product *= count;
    return product;
  }
  /// "[4, 2]"
  std::string text() const {
    std::string list;
    for (const std::uint16_t count : *this) list += (list.empty() ? "" : ", ") + std::to_string(count);
    return "[" + list + "]";
  }

 private:
  std::array<std::uint16_t, most_levels> counts_ = {};  ///< 0 from the first level on that is not there
};

}  // namespace noether

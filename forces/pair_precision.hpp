#pragma once
/// What forces between particles are computed in.

#include "engine/description.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace noether {

enum class PairPrecision : std::uint8_t {
  full,   ///< doubles
  mixed,  ///< forces between two particles in single precision, their sums in whole numbers; energies in doubles
};

template <> struct EnumNames<PairPrecision> {
  static constexpr std::array<std::pair<PairPrecision, std::string_view>, 2> values = {
      {{PairPrecision::full, "double"}, {PairPrecision::mixed, "mixed"}}};
};

namespace detail {
/// @throws Error  for mixed precision without a periodic box
void check_precision(PairPrecision precision, bool periodic, std::string_view name);
}  // namespace detail

}  // namespace noether

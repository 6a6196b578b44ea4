#pragma once
/// The cubic lattices that builders know.

#include "engine/description.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace noether {

/// Cubic Bravais lattices.
enum class LatticeKind : std::uint8_t { simple_cubic, body_centered, face_centered };

template <> struct EnumNames<LatticeKind> {
  static constexpr std::array<std::pair<LatticeKind, std::string_view>, 3> values = {
      {{LatticeKind::simple_cubic, "sc"}, {LatticeKind::body_centered, "bcc"}, {LatticeKind::face_centered, "fcc"}}};
};

}  // namespace noether

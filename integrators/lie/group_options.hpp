#pragma once
/// What a user may set of methods on Lie groups.

#include "integrators/method_options.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace noether {

/// On what group bodies move.
enum class BodyGroup : std::uint8_t {
  so3,  ///< orientations by rotations, places along straight lines
  se3   ///< both together by rigid motions: a body that flies and turns evenly goes along a screw
};
/// In whose axes spins (on SE(3) speeds too) go along straight lines.
enum class SpinAxes : std::uint8_t {
  body,  ///< Pi' = Pi x Omega + R^T torque: the torque of the weight of a top is felt as it turns
  space  ///< S' = torque: the spin of a free body stays to the bit, as on its coadjoint orbit
};

template <> struct EnumNames<BodyGroup> {
  static constexpr std::array<std::pair<BodyGroup, std::string_view>, 2> values{
      {{BodyGroup::so3, "so3"}, {BodyGroup::se3, "se3"}}};
};
template <> struct EnumNames<SpinAxes> {
  static constexpr std::array<std::pair<SpinAxes, std::string_view>, 2> values{
      {{SpinAxes::body, "body"}, {SpinAxes::space, "space"}}};
};

/// How rigid bodies stand on a group; for other fields it has no effect.
struct GroupOptions {
  BodyGroup group = BodyGroup::so3;
  SpinAxes spin_axes = SpinAxes::body;

  static constexpr auto describe() {
    return part<GroupOptions>("bodies_on_group", "how rigid bodies stand on a Lie group",
                              field<&GroupOptions::group>("group", "1", group_help),
                              field<&GroupOptions::spin_axes>("spin_axes", "1", spin_axes_help));
  }
  static constexpr std::string_view group_help =
      "of rigid bodies: so3 turns them and moves their centres along straight lines, se3 moves both along screws";
  static constexpr std::string_view spin_axes_help =
      "in whose axes spins of rigid bodies go along straight lines; space keeps that of a free body to the bit";

  bool operator==(const GroupOptions&) const = default;
};

/// The options of methods of Munthe-Kaas.
struct RkmkOptions {
  std::optional<std::int64_t> dexp_terms = {};  ///< default: what the order needs
  BodyGroup group = BodyGroup::so3;
  SpinAxes spin_axes = SpinAxes::body;

  static constexpr auto describe() {
    return part<RkmkOptions>(
        "munthe_kaas", "commutators of methods of Munthe-Kaas",
        field<&RkmkOptions::dexp_terms>("dexp_terms", "1",
                                        "commutators in dexp^-1 of a stage; default: as many as the order needs, its "
                                        "number less 2"),
        field<&RkmkOptions::group>("group", "1", GroupOptions::group_help),
        field<&RkmkOptions::spin_axes>("spin_axes", "1", GroupOptions::spin_axes_help));
  }
};

/// How bodies stand on a group, whatever the method.
inline GroupOptions group_options_of(const MethodOptions& options) {
  if (options.own.group() == &own_options<RkmkOptions>) {
    const auto own = options.own.as<RkmkOptions>();
    return {own.group, own.spin_axes};
  }
  return options.own.group() == &own_options<GroupOptions> ? options.own.as<GroupOptions>() : GroupOptions();
}

}  // namespace noether

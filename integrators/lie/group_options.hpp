#pragma once
/// What a user may set of methods on Lie groups.

#include "integrators/method_options.hpp"

#include <cstdint>
#include <optional>

namespace noether {

/// How rigid bodies stand on a group.
struct GroupOptions {
  BodyGroup group = BodyGroup::so3;
  SpinAxes spin_axes = SpinAxes::body;
};

/// As the options of a method have it.
inline GroupOptions group_options_of(const MethodOptions& options) {
  return {options.group.value_or(BodyGroup::so3), options.spin_axes.value_or(SpinAxes::body)};
}

/// The option of methods of Munthe-Kaas alone.
struct RkmkOptions {
  std::optional<std::int64_t> dexp_terms = {};  ///< default: what the order needs

  static constexpr auto describe() {
    return part<RkmkOptions>(
        "munthe_kaas", "commutators of methods of Munthe-Kaas",
        field<&RkmkOptions::dexp_terms>("dexp_terms", "1",
                                        "commutators in dexp^-1 of a stage; default: as many as the "
                                        "order needs, its number less 2"));
  }
};

}  // namespace noether

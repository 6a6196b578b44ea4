#pragma once
/// The speed of light of forces that know general relativity.

#include "engine/description.hpp"
#include "engine/particle_system.hpp"
#include "numbers/error.hpp"
#include "numbers/units.hpp"

#include <optional>
#include <string>

namespace noether {

/// @throws Error  unless it is above 0, where it is given
inline void check_speed_of_light(const std::optional<double>& c) {
  if (c && !(*c > 0)) refuse_field("c", *c, "is not a valid speed of light; a speed above 0 is expected");
}

/// The speed of light of a force: its own, or that of the units [length/time].
/// @throws Error  in reduced units, which have none
template <class Real>
Real speed_of_light_in(const ParticleSystem<Real>& s, const std::optional<double>& c, const char* force) {
  if (c) return Real(*c);
  const std::optional<double> known = speed_of_light(s.units());
  if (!known) {
    throw Error(std::string(force) + " needs the speed of light, which these units do not have; give c", {.key = "c"});
  }
  return Real(*known);
}

}  // namespace noether

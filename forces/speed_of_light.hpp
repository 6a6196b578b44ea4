#pragma once
/// What forces of general relativity about particle 0 share: the speed of light, their keys and their checks.

#include "engine/description.hpp"
#include "engine/particle_system.hpp"
#include "forces/primary.hpp"
#include "numbers/error.hpp"
#include "numbers/units.hpp"

#include <optional>
#include <string>
#include <string_view>

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

/// Why such a force does not stand twice in a scene.
inline constexpr std::string_view relativity_only_once = "so pericentres would advance twice; take one of them out";

/// The keys c and G of such a force, as they stand in its description.
template <class F> constexpr auto speed_of_light_field() {
  return field<&F::c>("c", "length/time", "speed of light; default: that of the unit system");
}
template <class F> constexpr auto gravitation_field() {
  return field<&F::G>("G", "length^3/mass/time^2", "default: the unit system's own");
}

/// @throws Error  for a G or c that is not above 0
template <class F> void check_relativity(const F& force) {
  check_constant_of_gravitation(force.G);
  check_speed_of_light(force.c);
}
/// @throws Error  where neither the force nor the units say what c is, and for a particle 0 without mass
template <class F, class Real> void check_relativity(const F& force, const ParticleSystem<Real>& s, const char* name) {
  speed_of_light_in(s, force.c, name);
  force.primary.check(s, name);
}

/// G m_0 [length^3/time^2]
template <class F, class Real> Real mu_of_primary(const F& force, const ParticleSystem<Real>& s) {
  return Real(force.G ? *force.G : s.units().G) * s.masses()[0];
}

}  // namespace noether

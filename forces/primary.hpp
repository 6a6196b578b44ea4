#pragma once
/// The primary of forces about particle 0.

#include "engine/particle_system.hpp"
#include "numbers/error.hpp"

#include <string>

namespace noether {

/// Reactions on the primary are over its mass: without one they are not numbers.
/// @throws Error  if particle 0 has no mass
template <class Real> void check_primary_has_mass(const ParticleSystem<Real>& s, const std::string& force) {
  if (s.size() == 0 || s.masses()[0] > Real(0)) return;
  throw Error(force + " is about particle 0, but '" + s.name(0) + "' has no mass; put the star first");
}

}  // namespace noether

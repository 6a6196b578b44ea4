#pragma once
/// Looks for numbers of a state that are no numbers any more.

#include "engine/outcome.hpp"
#include "engine/particle_system.hpp"

#include <optional>

namespace noether {

/// The first number of a state that is not finite: a variable, one of a column that moves, a position, a velocity.
/// @cost O(n), no allocation where all is well
template <class Real> std::optional<Failure> not_finite(const ParticleSystem<Real>& s);

}  // namespace noether

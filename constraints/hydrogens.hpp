#pragma once
/// Which particles are hydrogens.

#include "engine/particle_system.hpp"

#include <string_view>

namespace noether {

/// Whether a name is that of a hydrogen: it begins with H behind its digits, and is not another element's symbol.
bool is_hydrogen_name(std::string_view name);

/// Whether a particle is a hydrogen: by its mass, and by names where masses do not tell (structure_constraints.hpp).
/// @throws BadConstraints  where neither tells
bool is_hydrogen(const ParticleSystem<double>& s, Index i);

}  // namespace noether

#pragma once
/// Whether bodies of a run attract each other as masses do, and which of them the others orbit.

#include "scene/parts.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace noether {

/// Whether bodies of a scene attract each other as masses do, by what its parts claim.
bool has_gravity(const SceneValue& scene, const Parts& parts);

/// Whether they do as far as a scene tells: one that says nothing of forces, such as that of a program of its own, does
/// not tell that they do not.
bool may_have_gravity(const SceneValue& scene, const Parts& parts);

/// G of a scene; `of_units` where it gives none.
double constant_of_gravity(const SceneValue& scene, double of_units);

/// The heaviest body, if it is more than ten times as heavy as all others together.
std::optional<std::size_t> primary_of(const std::vector<double>& masses);

}  // namespace noether

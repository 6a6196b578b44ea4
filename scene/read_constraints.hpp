#pragma once
/// The tables [[hamiltonian.constraint]] of a scene.

#include "scene/scene.hpp"

#include <vector>

namespace noether {

/// Reads the tables of constraints on the particles of a scene, which are there already, into its Hamiltonian. Bonded
/// terms that constraints of the structure hold are taken out of the force `bonded`.
/// @return the tables with every default, as files store them
/// @throws SceneError
SceneValue::Array read_constraints(const SceneContext& context, const std::vector<const SceneValue*>& tables,
                                   const Parts& parts, Scene& scene);

/// Ends at the first table whose constraints, with those before it, the particles cannot keep; returns if it is none.
/// @throws SceneError
void refuse_constraints(const SceneContext& context, const std::vector<const SceneValue*>& tables, const Scene& scene);

}  // namespace noether

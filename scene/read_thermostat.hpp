#pragma once
/// The table [hamiltonian.thermostat] of a scene.

#include "scene/scene.hpp"

namespace noether {

/// Reads the bath of a scene, whose Hamiltonian has its kind and forces already.
/// @return the table with every default, as files store it
/// @throws SceneError
SceneValue read_thermostat(const SceneContext& context, const SceneValue& table, Scene& scene);

}  // namespace noether

#pragma once
/// The table [hamiltonian.thermostat] of a scene.

#include "scene/scene.hpp"

namespace noether {

/// Reads the bath of a scene, whose splitting and forces are read already.
/// @return the table with every default, as files store it
/// @throws SceneError
SceneValue read_thermostat(const SceneContext& context, const SceneValue& table, const Parts& parts, Scene& scene);

}  // namespace noether

#pragma once
/// The table [minimize] of a scene, and what it asks for.

#include "scene/scene.hpp"

namespace noether {

/// Reads how a scene begins, whose Hamiltonian is there already.
/// @return the table with every default, as files store it
/// @throws SceneError
SceneValue read_minimize(const SceneContext& context, const SceneValue& table, Scene& scene);

/// Brings the particles of a scene with a table [minimize] to a minimum; they are what the run begins with.
Minimized minimize_start(Scene& scene);

/// The same for studies; nothing where the scene has no such table. @throws SceneError  where no minimum is found
void begin_at_minimum(Scene& scene);

}  // namespace noether

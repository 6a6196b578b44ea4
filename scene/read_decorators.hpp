#pragma once
/// What stands around the method of a scene: [integrator.NAME] and [[integrator.decorator]].

#include "scene/scene.hpp"

namespace noether {

/// Reads it from the inside out: decorators under their own names, then the list.
/// @throws SceneError  for what is wrong in them
void read_decorators(TableReader& integrator, const Parts& parts, SceneIntegrator& made, SceneValue& effective);

}  // namespace noether

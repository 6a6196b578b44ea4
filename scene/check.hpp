#pragma once
/// What a scene must hold to before its first step, beyond what is said key by key.

#include "scene/scene.hpp"

namespace noether {

/// Puts the parts of a scene that has been read together: what they refuse is told with its place in the file.
/// @param root  the tree the scene was read from
/// @return the run as it was put together, `detail::assemble_start`
/// @throws SceneError
/// @cost one evaluation of the forces where two bodies stand in one place
Simulation<double> check_scene(const SceneContext& context, const SceneValue& root, const Scene& scene);

/// Holds a tree that other languages put together to what texts of scenes grant: each key once in its table, texts in
/// UTF-8, no tables too deep in one another.
/// @throws SceneError  naming the key
void check_tree(const SceneValue& root, const SceneSource& source);

}  // namespace noether

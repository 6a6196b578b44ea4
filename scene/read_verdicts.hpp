#pragma once
/// The tables [[verdict]] of a scene: what runs of it show, method by method.

#include "scene/scene.hpp"

namespace noether {

/// Reads the verdicts of a scene. @throws SceneError
std::vector<SceneVerdict> read_verdicts(const SceneContext& context, const std::vector<const SceneValue*>& tables);

}  // namespace noether

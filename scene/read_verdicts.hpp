#pragma once
/// The tables [[verdict]] of a scene: what runs of it show, method by method.

#include "scene/scene.hpp"

namespace noether {

/// Reads the verdicts of a scene. Only who judges runs reads them, so what is wrong there ends no run.
/// @param wrong  gets what is wrong in a verdict, which is then left out
std::vector<SceneVerdict> read_verdicts(const SceneContext& context, TableReader& top, std::vector<SceneError>& wrong);

}  // namespace noether

#pragma once
/// How small changes of the state go along with the run of a scene.

#include "engine/tangent_flow.hpp"
#include "scene/scene.hpp"

#include <memory>

namespace noether {

/// The tangent flow of a scene's run, for monitors of chaos.
/// @throws Error  naming the part of the run that has no derivative
std::unique_ptr<TangentFlow<double>> tangents_of(const Scene& scene, Index changes);

}  // namespace noether

#pragma once
/// What commands tell of a scene, as one line of JSON: for bindings to other languages too.

#include "scene/evaluate.hpp"
#include "scene/scene.hpp"

#include <string>

namespace noether {

/// What `noether explain --json` prints: schema noether.explain/1.
/// @cost as an explanation: some steps of the scene
std::string explanation_json(const Scene& scene);
/// What `noether evaluate --json` prints: schema noether.evaluate/1.
std::string evaluation_json(const Scene& scene, const Evaluation& found);

}  // namespace noether

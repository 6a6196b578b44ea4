#pragma once
/// What `explain` tells of meshes of charges.

#include "scene/json.hpp"
#include "scene/scene.hpp"

#include <string>

namespace noether {

/// The points, the order and alpha that the mesh of charges has, and its errors; empty without one.
std::string mesh_text(const Scene& scene);
/// The same; null without one.
Json mesh_json(const Scene& scene);

}  // namespace noether

#pragma once
/// What `explain` tells of rigid bodies.

#include "scene/json.hpp"
#include "scene/scene.hpp"

#include <string>

namespace noether {

/// How many bodies and sites there are, how they turn, and how far in a step; empty without bodies.
std::string bodies_text(const Scene& scene);
/// The same; null without bodies.
Json bodies_json(const Scene& scene);

}  // namespace noether

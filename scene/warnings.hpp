#pragma once
/// What a scene brings and none of its forces looks at.

#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace noether {

/// One line for each kind of thing that is in the scene and does nothing: it can be run, but is hardly meant.
std::vector<std::string> warnings_of(const Scene& scene);

}  // namespace noether

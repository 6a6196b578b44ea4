#pragma once
/// How fast fields turn the charges of a scene, in words.

#include <string>

namespace noether {

struct Scene;

/// "gyration: 'ion' turns by 0.299 rad a step at the start, 21 steps a turn": of the charge that turns fastest; empty
/// without a field.
std::string gyration_text(const Scene& scene);

}  // namespace noether

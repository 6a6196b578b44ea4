#pragma once
/// Every key that a scene may have, on one page.

#include "scene/parts.hpp"

namespace noether {

/// Prints every table and every part with its keys, as Markdown (docs/keys.md) or as one line of JSON.
void describe_all(const Parts& parts, bool json);

}  // namespace noether

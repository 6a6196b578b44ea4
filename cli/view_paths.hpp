#pragma once
/// How bodies move between the frames of a page.

#include "cli/view_data.hpp"

namespace noether {

/// Fills `paths` and `spacing`. Bodies that frames show densely move smoothly; of few bodies about a primary those move
/// on Kepler arcs whose arcs lead from frame to frame; what frames show too seldom jumps.
void choose_paths(ViewData& data);

}  // namespace noether

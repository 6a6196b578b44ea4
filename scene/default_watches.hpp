#pragma once
/// What watches the run of a scene without [[every]]: the energy, where there is one, and about 200 frames.

#include "engine/saved_state.hpp"
#include "scene/scene.hpp"

#include <map>
#include <string>

namespace noether {

/// Gives a scene that has been read without [[every]] its watches, in its effective tree too.
///
/// Both look at equal distances: whole numbers of steps, a divisor of all of them where one gives 100 to 400 frames, or
/// of time where the method chooses its steps. Frames are fewer than 200 where they would fill more than 2 GB, and none
/// where this build can write no files. A scene without an end gets nothing: it cannot be run.
/// @param claims  of its integrator: whether the energy is known
void add_default_watches(const SceneContext& context, Scene& scene, const IntegratorClaims& claims);

/// Gives a scene with default watches the cadences of the run that it goes on with, whose end may have been another.
/// @param stored  the scene of that run; where it has other watches, nothing is done
/// @return a note where that run had other cadences than the default ones of its end, such as where [[every]] tables
///         have been taken out since it began; else ""
std::string keep_default_watches(const SceneValue& stored, Scene& scene);

/// What the checkpoints of a run with kept watches carry beside its parts, so that its next resume does not note them
/// once more; nothing for other runs.
std::map<std::string, SavedState> mark_of_kept_watches(const Scene& scene);
/// Whether a saved run has such a mark.
bool told_of_kept_watches(const SavedRun& run);

}  // namespace noether

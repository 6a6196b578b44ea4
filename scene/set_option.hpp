#pragma once
/// `--set key.path=value`: changes to a scene from the command line.

#include "scene/parts.hpp"
#include "scene/reader.hpp"

namespace noether {

/// Applies every `source.sets`, in order.
///
/// A path goes through tables by key, through lists of tables by index, by `type` where that is unique, or by `name`:
/// `every.0.steps`, `hamiltonian.force.lennard_jones.cutoff`, `particles.body.Saturn.a`. The value is TOML, or else a
/// text; nothing behind the sign takes the key out. A text "--until T" is the option of that name. A key that excludes
/// another (`steps` and `until`, `steps` and `every`) replaces it.
/// @param parts  whose keys are proposed where a path begins too late: "step" for "integrator.step"
/// @throws SceneError  if there is no such path, with a proposal
void apply_sets(SceneValue& scene, const SceneSource& source, const Parts& parts);

}  // namespace noether

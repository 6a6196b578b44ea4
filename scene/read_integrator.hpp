#pragma once
/// Reading `[integrator]`, and how often monitors look.

#include "scene/scene.hpp"

namespace noether {

/// Reads the method, its step or tolerances, the end of the run, and what stands around the method.
/// @param constrained  whether the Hamiltonian has constraints
/// @param effective  receives the table with every default
/// @throws SceneError  at the line of the key
SceneIntegrator read_integrator(const SceneContext& context, const SceneValue& table, const Parts& parts,
                                bool constrained, SceneValue& effective);

/// Reads a method and its options alone, without a step or an end.
/// @throws SceneError
SceneIntegrator read_method_alone(const SceneContext& context, const SceneValue& table, const Parts& parts,
                                  SceneValue& effective);

/// Reads the cadence of a monitor, a writer or a stop: `every`, `steps`, `wall` or `times`.
/// @param effective  receives what the scene wrote
/// @throws SceneError
Cadence read_cadence(TableReader& reader, bool may_be_wall, const SceneIntegrator& integrator, SceneValue& effective);

/// Reads `after`, the time before which a cadence of steps or time has no looks.
/// @param effective  receives what the scene wrote
/// @throws SceneError  for one before the start, or so late that the run ends before a look
void read_after(TableReader& reader, const SceneIntegrator& integrator, Cadence& cadence, SceneValue& effective);

}  // namespace noether

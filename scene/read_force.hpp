#pragma once
/// Reading one force: what `[[hamiltonian.force]]` and `make_force` have in common.

#include "scene/scene.hpp"

namespace noether {

/// Reads what a force says of itself, whom it ties, and which kick it is in.
/// @param s  where a force that ties some particles finds them; null where there are none to be found
/// @param effective  receives the table with every default
/// @throws SceneError  at the line of the key
SceneForce read_force(TableReader& reader, const Parts::ForceKind& kind, const ParticleSystem<double>* s,
                      SceneValue& effective);

/// Moves a force into the kick that its table names. @throws SceneError  for what is no kick
void set_kick(TableReader& reader, SceneForce& force);

/// Refuses a force that the splitting has in itself, and one that stands twice where it must not.
/// @param reader  of the table of the force
/// @param made  the forces that stand before it
/// @throws SceneError
void check_force_beside(const TableReader& reader, const Parts::ForceKind& kind, const SceneForce& force,
                        const SceneHamiltonian& made, const Parts& parts);

/// Whether a splitting sums a force over images itself, though the force knows none: in boxes whose images slide.
bool sums_images_of(const SceneSplitting& splitting, const SceneForce& force, const ParticleSystem<double>& particles);

/// Refuses a force that cannot act on the sites of rigid bodies, or on bodies themselves, and one that has the second
/// degree of particle 0, a rigid body, beside another one that has it.
/// @param made  the forces that stand before it
/// @throws SceneError
void check_force_on_bodies(const TableReader& reader, const Parts::ForceKind& kind, const SceneForce& force,
                           const SceneHamiltonian& made, const ParticleSystem<double>& s);

}  // namespace noether

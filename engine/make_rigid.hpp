#pragma once
/// Molecules as rigid bodies.

#include "engine/bodies.hpp"

namespace noether {

/// Makes a rigid body of every molecule of two atoms or more; atoms by themselves stay points.
///
/// A molecule is what bonds hold together, or has one number where there are no bonds. Its atoms are the sites of the
/// body, with their masses, charges and types; centre, axes, moments, velocity and spin follow from them, in a box by
/// nearest images. Molecules of equal atoms in equal order are of one kind: all have the shape of the first, laid over
/// their own atoms (the rotation of least squares, Horn1987), so that rounded coordinates of a file make no difference.
/// Bodies stand where the first atoms of their molecules did, among the points.
/// @param tolerance  how far an atom may be from its place in the first molecule of its kind [length], relative to the
///   farthest from the centre
/// @throws Error  for a molecule of another shape, atoms in one place, and pairs between molecules that are excluded
/// @cost O(atoms log atoms)
/// @source Horn1987
ParticleSystem<double> make_rigid(const ParticleSystem<double>& atoms, double tolerance = 0.05);

}  // namespace noether

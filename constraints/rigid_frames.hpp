#pragma once
/// Distances that hold a molecule as a rigid body.

#include "engine/particle_system.hpp"

#include <utility>
#include <vector>

namespace noether {

/// Pairs of a molecule whose distances make it rigid: none of one site, one of two, all three of three, and 3 N - 6 of
/// N > 3, of which no other follows.
///
/// Of N > 3, four sites span a tetrahedron, each as far as there is one from the line or plane of those before; every
/// other site is tied to the three of them toward which its directions are least in one plane.
/// @param molecule  its particles, ascending; each at its image nearest to the first
/// @throws BadConstraints  for three sites in line, and for more that lie in a plane
/// @cost O(N)
std::vector<std::pair<Index, Index>> rigid_frame(const ParticleSystem<double>& s, const std::vector<Index>& molecule);

}  // namespace noether

#pragma once
/// Are the flows of a split Hamiltonian those of its energy? Asked by differences.

#include "engine/erasure.hpp"

namespace noether {

/// Compares what all letters together do to particles in no time with Hamilton's equations of the energy that they
/// report: how centres move and are kicked, how bodies turn and are twisted,
///
///     x' = dH/dp,  p' = - dH/dx;   angular velocity = dH/dS,  S' = - dH/d(turn of q and S)
///
/// Flows need not be exact. Up to 64 particles are asked one by one, of more 16; errors of the differences are some
/// 1e-7 of the largest value of each kind, 1e-5 is allowed. Places that fixed points hold, and what has no mass, are
/// not asked.
/// @throws Error  where one of the four differs, with the particle and the axis that differ most; for a Hamiltonian
///                without an energy, with letters that no energy tells, constraints or coordinates of its own
/// @cost 6 flows of each letter, and 36 energies for each particle that is asked, of a body 72
void check_flows(AnyHamiltonian<double> hamiltonian, ParticleSystem<double> s);

}  // namespace noether

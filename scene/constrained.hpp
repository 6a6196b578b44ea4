#pragma once
/// Forces and constraints under one Hamiltonian, as scenes have them. Integrators and constraints do not know each
/// other, so what takes both is compiled here, once.

#include "constraints/constraint_solver.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/minimize.hpp"

namespace noether {

/// Moves particles downhill along constraints (integrators/minimize.hpp).
/// @throws Error  as without constraints; BadConstraints  where the particles do not start on them
Minimized minimize(ParticleSystem<double>& s, const AnyForce<double>& forces, const ConstraintSet& constraints,
                   const MinimizeOptions& options);

using Constrained = KineticPotential<ForceField<double>, double, ConstraintSet>;

extern template class KineticPotential<ForceField<double>, double, ConstraintSet>;
extern template struct detail::HamiltonianModel<Constrained>;

}  // namespace noether

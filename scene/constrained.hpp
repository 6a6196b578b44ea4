#pragma once
/// Forces and constraints under one Hamiltonian, as scenes have them. Integrators and constraints do not know each
/// other, so what takes both is compiled here, once.

#include "constraints/constraint_solver.hpp"
#include "integrators/kinetic_potential.hpp"

namespace noether {

using Constrained = KineticPotential<ForceField<double>, double, ConstraintSet>;

extern template class KineticPotential<ForceField<double>, double, ConstraintSet>;
extern template struct detail::HamiltonianModel<Constrained>;

}  // namespace noether

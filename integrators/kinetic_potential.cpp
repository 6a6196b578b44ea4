#include "integrators/kinetic_potential.hpp"

namespace noether {

template class KineticPotential<ForceField<double>>;
template class KineticPotential<ForceField<Quad>, Quad>;
template struct detail::HamiltonianModel<KineticPotential<ForceField<double>>>;
template struct detail::HamiltonianModel<KineticPotential<ForceField<Quad>, Quad>>;

}  // namespace noether

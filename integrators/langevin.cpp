#include "integrators/langevin.hpp"

namespace noether {

template class Langevin<KineticPotential<ForceField<double>>>;
template struct detail::HamiltonianModel<Langevin<KineticPotential<ForceField<double>>>>;

}  // namespace noether

#include "scene/constrained.hpp"

namespace noether {

template class KineticPotential<ForceField<double>, double, ConstraintSet>;
template class Langevin<Constrained>;
template struct detail::HamiltonianModel<Constrained>;
template struct detail::HamiltonianModel<Langevin<Constrained>>;

}  // namespace noether

#include "scene/constrained.hpp"

namespace noether {

template class KineticPotential<ForceField<double>, double, ConstraintSet>;
template struct detail::HamiltonianModel<Constrained>;

}  // namespace noether

#include "forces/gr_potential.hpp"

namespace noether {

template struct detail::ForceModel<GrPotential, double>;
template struct detail::ForceModel<GrPotential, Quad>;

}  // namespace noether

#include "forces/sum.hpp"

namespace noether {

template class ForceField<double>;
template class ForceField<Quad>;

}  // namespace noether

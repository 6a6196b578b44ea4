#include "integrators/force_motion.hpp"

namespace noether {

template class ForceMotion<ForceField<double>, double>;
template class ForceMotion<ForceField<Quad>, Quad>;

}  // namespace noether

#include "constraints/surfaces.hpp"

namespace noether {

template class ConstraintsOf<Fixed>;
template class ConstraintsOf<OnSphere>;
template class ConstraintsOf<OnPlane>;
template class ConstraintsOf<OnCylinder>;
template class ConstraintsOf<OnCircle>;
template class ConstraintsOf<OnLine>;

}  // namespace noether

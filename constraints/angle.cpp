#include "constraints/angle.hpp"

namespace noether {

template class ConstraintsOf<Angle>;

}  // namespace noether

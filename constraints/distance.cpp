#include "constraints/distance.hpp"

namespace noether {

template class ConstraintsOf<Distance>;

}  // namespace noether

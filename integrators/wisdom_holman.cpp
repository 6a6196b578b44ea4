#include "integrators/wisdom_holman.hpp"

namespace noether {

template class WisdomHolman<double>;
template class WisdomHolman<Quad>;

}  // namespace noether

#include "forces/anharmonic_chain.hpp"

namespace noether {

template struct detail::ForceModel<AnharmonicChain, double>;
template struct detail::ForceModel<AnharmonicChain, Quad>;

}  // namespace noether

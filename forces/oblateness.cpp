#include "forces/oblateness.hpp"

namespace noether {

template struct detail::ForceModel<Oblateness, double>;
template struct detail::ForceModel<Oblateness, Quad>;

}  // namespace noether

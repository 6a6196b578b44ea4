#include "forces/springs.hpp"

namespace noether {

template struct detail::ForceModel<HarmonicBond, double>;
template struct detail::ForceModel<HarmonicBond, Quad>;
template struct detail::ForceModel<Tether, double>;
template struct detail::ForceModel<Tether, Quad>;

}  // namespace noether

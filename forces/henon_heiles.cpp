#include "forces/henon_heiles.hpp"

namespace noether {

template struct detail::ForceModel<HenonHeiles, double>;
template struct detail::ForceModel<HenonHeiles, Quad>;

}  // namespace noether

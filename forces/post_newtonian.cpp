#include "forces/post_newtonian.hpp"

namespace noether {

template struct detail::ForceModel<PostNewtonian, double>;
template struct detail::ForceModel<PostNewtonian, Quad>;

}  // namespace noether

#include "forces/fermi_pasta_ulam.hpp"

namespace noether {

template struct detail::ForceModel<FermiPastaUlam, double>;
template struct detail::ForceModel<FermiPastaUlam, Quad>;

}  // namespace noether

#include "integrators/tidal.hpp"

namespace noether {

template class Tidal<AnyHamiltonian<double>>;
template struct detail::HamiltonianModel<Tidal<AnyHamiltonian<double>>>;

}  // namespace noether

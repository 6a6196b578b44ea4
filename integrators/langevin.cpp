#include "integrators/langevin.hpp"

namespace noether {

template class Langevin<AnyHamiltonian<double>>;
template struct detail::HamiltonianModel<Langevin<AnyHamiltonian<double>>>;

}  // namespace noether

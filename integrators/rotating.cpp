#include "integrators/rotating.hpp"

namespace noether {

template class Rotating<AnyHamiltonian<double>>;
template class Rotating<AnyHamiltonian<Quad>>;
template struct detail::HamiltonianModel<Rotating<AnyHamiltonian<double>>>;
template struct detail::HamiltonianModel<Rotating<AnyHamiltonian<Quad>>>;

}  // namespace noether

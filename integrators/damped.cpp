#include "integrators/damped.hpp"

namespace noether {

template class Damped<AnyHamiltonian<double>>;
template struct detail::HamiltonianModel<Damped<AnyHamiltonian<double>>>;

}  // namespace noether

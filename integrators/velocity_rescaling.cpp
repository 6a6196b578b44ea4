#include "integrators/velocity_rescaling.hpp"

namespace noether {

template class VelocityRescaling<AnyHamiltonian<double>>;
template struct detail::HamiltonianModel<VelocityRescaling<AnyHamiltonian<double>>>;

}  // namespace noether

#include "integrators/wisdom_holman.hpp"

namespace noether {

template class WisdomHolman<double>;
template class WisdomHolman<Quad>;
template class WisdomHolman<double, ForceField<double>>;
template class WisdomHolman<Quad, ForceField<Quad>>;
template struct detail::HamiltonianModel<WisdomHolman<double>>;
template struct detail::HamiltonianModel<WisdomHolman<double, ForceField<double>>>;
template struct detail::HamiltonianModel<WisdomHolman<Quad>>;
template struct detail::HamiltonianModel<WisdomHolman<Quad, ForceField<Quad>>>;

}  // namespace noether

#include "integrators/k_symplectic.hpp"

#include <fmt/format.h>

namespace noether {

void KSymplecticOptions::check() const {
  if (nodes >= 1 && nodes <= 32) return;
  refuse_field("nodes", fmt::format("{}", nodes), "is not a valid count of nodes; 1 to 32 are expected");
}

template class KSymplectic<ForceField<double>>;
template class KSymplectic<ForceField<Quad>, Quad>;
template struct detail::HamiltonianModel<KSymplectic<ForceField<double>>>;
template struct detail::HamiltonianModel<KSymplectic<ForceField<Quad>, Quad>>;

}  // namespace noether

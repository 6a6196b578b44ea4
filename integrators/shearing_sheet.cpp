#include "integrators/shearing_sheet.hpp"

namespace noether {

void ShearingSheetOptions::check() const {
  if (!(Omega > 0) || !std::isfinite(Omega)) {
    refuse_field("Omega", Omega, "is not a valid angular velocity of the frame; a number above 0 is expected");
  }
  if (Omega_z && (!(*Omega_z >= 0) || !std::isfinite(*Omega_z))) {
    refuse_field("Omega_z", *Omega_z, "is not a valid angular velocity; 0 (no force along z) or more is expected");
  }
}

template class ShearingSheet<ForceField<double>>;
template class ShearingSheet<ForceField<Quad>, Quad>;
template struct detail::HamiltonianModel<ShearingSheet<ForceField<double>>>;
template struct detail::HamiltonianModel<ShearingSheet<ForceField<Quad>, Quad>>;

}  // namespace noether

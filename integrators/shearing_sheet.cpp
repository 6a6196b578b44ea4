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

AnyHamiltonian<double> with_letter(const HardSpheres& law, const AnyHamiltonian<double>& hamiltonian) {
  const auto* sheet = hamiltonian.as<ShearingSheet<ForceField<double>>>();
  if (sheet == nullptr) {
    throw SchemeMismatch("hard spheres are those of 'shearing_sheet', not of '" + detail::name_of(hamiltonian) +
                         "'; use that, name them before drag, or take hard_spheres out");
  }
  ShearingSheet<ForceField<double>> with_spheres = *sheet;
  with_spheres.add_spheres(law);
  return with_spheres;
}

template class ShearingSheet<ForceField<double>>;
template class ShearingSheet<ForceField<Quad>, Quad>;
template struct detail::HamiltonianModel<ShearingSheet<ForceField<double>>>;
template struct detail::HamiltonianModel<ShearingSheet<ForceField<Quad>, Quad>>;

}  // namespace noether

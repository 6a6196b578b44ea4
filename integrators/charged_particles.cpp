#include "integrators/charged_particles.hpp"

#include "forces/speed_of_light.hpp"

#include <fmt/format.h>

namespace noether {

void ChargedParticlesOptions::check() const {
  const bool hyper = rotation == Rotation::hyper_boris;
  if (cycles < 1)
    refuse_field("cycles", fmt::format("{}", cycles), "is not a valid count of turns; 1 or more is expected");
  if (gyrophase_order < 2 || gyrophase_order > 16 || gyrophase_order % 2 != 0) {
    refuse_field("gyrophase_order", fmt::format("{}", gyrophase_order),
                 "is not a valid order of an angle; an even number from 2 to 16 is expected");
  }
  const ChargedParticlesOptions usual{};
  if (!hyper && cycles != usual.cycles) {
    refuse_field("cycles", fmt::format("{}", cycles),
                 "counts turns of rotation = \"hyper_boris\"; give that, or take it out");
  }
  if (!hyper && gyrophase_order != usual.gyrophase_order) {
    refuse_field("gyrophase_order", fmt::format("{}", gyrophase_order),
                 "is that of rotation = \"hyper_boris\"; give that, or take it out");
  }
  if (relativistic != Relativistic::no && rotation != usual.rotation) {
    refuse_field("rotation", rotation == Rotation::boris ? "\"boris\"" : "\"hyper_boris\"",
                 "is for slow particles; relativistic says how fast ones turn, so take one of the two out");
  }
  if (canonical && relativistic != Relativistic::no) {
    refuse_field("canonical", "true", "is for slow particles; take it out, or relativistic");
  }
  check_speed_of_light(c);
  if (c && relativistic == Relativistic::no) {
    refuse_field("c", *c, "is that of relativistic particles; give relativistic = \"higuera_cary\", or take it out");
  }
}

std::optional<double> ChargedParticlesOptions::light(const UnitSystem& units) const {
  if (relativistic == Relativistic::no) return {};
  const std::optional<double> known = c ? c : speed_of_light(units);
  if (known) return known;
  throw Error("relativistic particles need the speed of light, which these units do not have; give c", {.key = "c"});
}

template class ChargedParticles<ForceField<double>>;
template class ChargedParticles<ForceField<Quad>, Quad>;
template struct detail::HamiltonianModel<ChargedParticles<ForceField<double>>>;
template struct detail::HamiltonianModel<ChargedParticles<ForceField<Quad>, Quad>>;

}  // namespace noether

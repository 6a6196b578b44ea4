#include "forces/electromagnetic_fields.hpp"

namespace noether {

#define NOETHER_FIELD(FIELD)                                  \
  template struct detail::ForceModel<InField<FIELD>, double>; \
  template struct detail::ForceModel<InField<FIELD>, Quad>;
NOETHER_FIELD(UniformElectromagnetic)
NOETHER_FIELD(GradientField)
NOETHER_FIELD(MagneticMirror)
NOETHER_FIELD(MagneticDipole)
NOETHER_FIELD(Tokamak)
NOETHER_FIELD(PenningTrap)
NOETHER_FIELD(PlaneWave)
NOETHER_FIELD(RadioFrequencyGap)
#undef NOETHER_FIELD

}  // namespace noether

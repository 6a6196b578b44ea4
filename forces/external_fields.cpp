#include "forces/external_fields.hpp"

namespace noether {

template struct detail::ForceModel<UniformField, double>;
template struct detail::ForceModel<UniformField, Quad>;
template struct detail::ForceModel<OscillatingField, double>;
template struct detail::ForceModel<OscillatingField, Quad>;
template struct detail::ForceModel<HarmonicField, double>;
template struct detail::ForceModel<HarmonicField, Quad>;

}  // namespace noether

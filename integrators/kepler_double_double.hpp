#pragma once
/// Kepler arcs in double-double precision: what long runs add up without any rounding that doubles could see.

#include "integrators/kepler.hpp"
#include "numbers/double_double.hpp"

namespace noether {

/// The arc of `kepler_arc`, its increments right to some 1e-30 of |x| and |v| on planetary arcs (on others to what the
/// last bits of the inputs make uncertain). The universal variable is found in doubles; one step from there is made in
/// double-double. Where doubles do not find it, or the step is long, the whole arc is computed in double-double.
///
/// `iterations` counts evaluations in double-double alone.
/// @cost one arc in doubles, and four universal functions in double-double: about 1 us
/// @throws never
/// @source WisdomHernandez2015, Dekker1971
template <>
KeplerArc<DoubleDouble> kepler_arc(const Vec3<DoubleDouble>& x, const Vec3<DoubleDouble>& v, DoubleDouble mu,
                                   DoubleDouble h);

}  // namespace noether

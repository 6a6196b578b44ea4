#pragma once
/// The two-body problem solved exactly: one arc of any orbit, over any time.

#include "numbers/real.hpp"
#include "numbers/types.hpp"

#include <cstdint>

namespace noether {

/// How the solution of Kepler's equation ended.
enum class KeplerStatus : std::uint8_t {
  converged,      ///< residual at rounding level
  not_converged,  ///< iterations spent; the increments are the best estimate
  not_finite      ///< an input is not finite, the body is at the center, or a result overflows; increments are zero
};

/// What one arc adds to position and velocity.
template <class Real> struct KeplerArc {
  Vec3<Real> dx = Vec3<Real>::Zero();  ///< x1 - x0 [length]
  Vec3<Real> dv = Vec3<Real>::Zero();  ///< v1 - v0 [length/time]
  Real s = Real(0);                    ///< integral of dt/r over the arc, whole periods included [time/length]
  int iterations = 0;                  ///< evaluations of Kepler's equation
  KeplerStatus status = KeplerStatus::converged;
};

/// Advances a body by time h on its orbit about a fixed center of attraction.
///     x'' = -mu x / |x|^3,  dx = (f - 1) x + g v,  dv = f' x + (g' - 1) v
/// Ellipses, parabolas, hyperbolas and straight lines, h of either sign and any number of periods; mu may be zero
/// (free motion; s = 0 if the line meets the center, where the integral diverges) or negative (repulsion). A body on
/// a line through the center bounces there, as the limit of ever thinner ellipses does. Reversing v and h gives
/// the same arc, bit for bit. `integrators/kepler_impl.hpp` holds the definition for further number types.
/// @param x position [length]
/// @param v velocity [length/time]
/// @param mu gravitational parameter [length^3/time^2]
/// @param h time [time]
/// @throws never
/// @cost one evaluation of four universal functions on most planetary arcs, at most 400 on any; no allocation
/// @source ReinTamayo2015, WisdomHernandez2015
template <class Real> KeplerArc<Real> kepler_arc(const Vec3<Real>& x, const Vec3<Real>& v, Real mu, Real h);

extern template KeplerArc<double> kepler_arc(const Vec3<double>&, const Vec3<double>&, double, double);
extern template KeplerArc<Quad> kepler_arc(const Vec3<Quad>&, const Vec3<Quad>&, Quad, Quad);

}  // namespace noether

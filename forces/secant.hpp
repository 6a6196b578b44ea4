#pragma once
/// Secant forces of pairs: between two states, with the difference of the energies as their work.

#include "engine/force_sink.hpp"

namespace noether {

/// Energy of a pair, and the force along its line of centres over their distance: -U'(r) / r.
template <class Real> struct PairTerms { Real energy, force; };

}  // namespace noether

namespace noether::detail {

/// Force over distance, k, of a pair that goes from the distance vector d0 to d1: f = k (d0 + d1) / 2 on the first of
/// them, with f . (d1 - d0) = U0 - U1 to rounding.
///
///     k = - 2 (U1 - U0) / (r1^2 - r0^2);   where both distances all but agree, -U'(r)/r in the middle
///
/// @param terms  (r2): energy and -U'(r)/r of the pair, as `PairTerms`
/// @source LaBuddeGreenspan1976
template <class Real, class Terms> Real secant_of(const Real& from2, const Real& to2, const Terms& terms) {
  using std::abs;
  const Real step = to2 - from2, size = to2 + from2;
  // Nearer than that a quotient of differences tells less than the derivative: either is good to about 1e-10.
  if (!(abs(step) > Real(1e-5) * size)) return terms(size / Real(2)).force;
  return Real(-2) * (terms(to2).energy - terms(from2).energy) / step;
}

/// Adds the secant force of a pair of particles from `d0` to `d1`, the distance vectors from j to i, times `factor`.
template <class Real, class Terms>
void add_secant_pair(ForceSink<Real>& out, Index i, Index j, const Vec3<Real>& d0, const Vec3<Real>& d1,
                     const Real& factor, const Terms& terms) {
  const Real k = factor * secant_of(norm2(d0), norm2(d1), terms);
  out.pair(i, j, Vec3<Real>(k / Real(2) * (d0 + d1)));
}

}  // namespace noether::detail

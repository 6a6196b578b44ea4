#pragma once
/// The magnetic field of a circular loop of current, everywhere but on the wire.

#include "forces/electromagnetic_field.hpp"
#include "numbers/select.hpp"

#include <cmath>

namespace noether::detail {

/// Bulirsch's complete elliptic integral as a mean over the angle,
///
///     2/pi int_0^{pi/2} (a cos^2 + b sin^2)/((cos^2 + p sin^2) sqrt(cos^2 + k'^2 sin^2)) d theta,  p > 0
///
/// by as many means as leave rounding for k' down to 1e-8: the same count in every lane.
/// @cost twelve square roots
/// @source Bulirsch1969
template <class Real> Real cel_mean(Real kc, Real p, Real a, Real b) {
  using std::sqrt;
  constexpr int means = 12;
  p = sqrt(p);
  b = b / p;
  Real e = kc, m(1), k = kc;
  Real f = a;
  a += b / p;
  Real g = e / p;
  b += f * g;
  b += b;
  p += g;
  g = m;
  m += k;
  for (int round = 0; round < means; ++round) {
    k = sqrt(e);
    k += k;
    e = k * m;
    f = a;
    a += b / p;
    g = e / p;
    b += f * g;
    b += b;
    p += g;
    g = m;
    m += k;
  }
  return (b + a * m) / (m * (m + p));
}

/// Adds B and A of a loop of radius `a` about the z axis in the plane z = 0; `B0` is B at its center.
///
///     B_rho = C z/s^3 cel_mean(k', k'^2, -1, 1)
///     B_z   = C/s^3 cel_mean(k', k'^2, a + rho, a - rho)
///     A_phi = C/s cel_mean(k', 1, -1, 1)
///     s^2 = (a + rho)^2 + z^2,  k'^2 = ((a - rho)^2 + z^2)/s^2,  C = B0 a^2
template <class Real> void add_loop(const Real& B0, const Real& a, const Vec3<Real>& x, FieldValues<Real>& field) {
  using std::sqrt;
  const Real rho2 = x[0] * x[0] + x[1] * x[1], z = x[2];
  // On the axis nothing has a direction: what goes with x/rho is 0 there.
  const auto on_axis = rho2 == Real(0);
  const Real rho = noether::select(on_axis, Real(0), Real(sqrt(noether::select(on_axis, Real(1), rho2))));
  const Real sum = a + rho, difference = a - rho;
  const Real s2 = sum * sum + z * z, s = sqrt(s2), kc2 = (difference * difference + z * z) / s2, kc = sqrt(kc2);
  const Real C = B0 * a * a;
  const Real cubed = C / (s2 * s);
  const Real along = noether::select(on_axis, Real(0), Real(Real(1) / noether::select(on_axis, Real(1), rho)));
  const Real outward = cubed * z * cel_mean(kc, kc2, Real(-1), Real(1)) * along;
  const Real around = C / s * cel_mean(kc, Real(1), Real(-1), Real(1)) * along;
  field.B += Vec3<Real>(outward * x[0], outward * x[1], cubed * cel_mean(kc, kc2, sum, difference));
  field.A += Vec3<Real>(-around * x[1], around * x[0], Real(0));
}

}  // namespace noether::detail

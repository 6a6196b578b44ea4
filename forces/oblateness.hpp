#pragma once
/// The zonal harmonics J2 and J4 of an oblate primary.

#include "engine/any_force.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "forces/primary.hpp"
#include "forces/secant.hpp"

#include <array>
#include <cmath>
#include <optional>

namespace noether {

/// Field of an oblate primary (particle 0) about a fixed axis n, with the reaction on the primary.
///
///     U = sum_i m_i (G m_0 / r) [J2 (R/r)^2 P2(c) + J4 (R/r)^4 P4(c)],   r = |x_i - x_0|,   c = (x_i - x_0) . n / r
///
/// P2, P4 are Legendre polynomials. Tracers feel it.
/// @cost O(n), no allocation
/// @source MurrayDermott1999
struct Oblateness {
  double J2 = 0.0;                         ///< [1]
  double J4 = 0.0;                         ///< [1]
  double radius = 0.0;                     ///< equatorial radius of the primary [length]
  std::array<double, 3> axis = {0, 0, 1};  ///< direction of the axis; its length does not matter
  std::optional<double> G = {};            ///< [length^3/mass/time^2]; default: the unit system's own
  Primary primary = {};                    ///< particle 0 of the run

  static constexpr auto describe() {
    return part<Oblateness>(
        "oblateness", "zonal harmonics J2 and J4 of particle 0",
        formula("U = sum_i m_i (G m_0/r) [J2 (R/r)^2 P2(c) + J4 (R/r)^4 P4(c)]"), source("MurrayDermott1999"),
        field<&Oblateness::J2>("J2", "1"), field<&Oblateness::J4>("J4", "1"),
        field<&Oblateness::radius>("radius", "length", "equatorial radius of the primary").required("\"60330 km\""),
        field<&Oblateness::axis>("axis", "1", "direction of the axis of symmetry"),
        field<&Oblateness::G>("G", "length^3/mass/time^2", "default: the unit system's own"));
  }

  static ForceClaims claims() { return {.keeps_angular_momentum = false, .charges = false, .exclusions = false}; }

  /// @throws Error  without J2 and J4, a radius above 0, or an axis that has a direction
  void check() const {
    check_constant_of_gravitation(G);
    if (J2 == 0 && J4 == 0) throw Error("oblateness has neither J2 nor J4, so it would do nothing; give one");
    if (!(radius > 0)) refuse_field("radius", radius, "is not a valid radius; a length above 0 is expected");
    if (axis[0] == 0 && axis[1] == 0 && axis[2] == 0) {
      refuse_field("axis", axis, "has no direction; expected one such as [0, 0, 1]");
    }
  }

  /// @throws Error  for a particle 0 without mass
  template <class Real> void check(const ParticleSystem<Real>& s) const { primary.check(s, "oblateness"); }

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    using std::sqrt;
    Vec3<Real> n{Real(axis[0]), Real(axis[1]), Real(axis[2])};
    n /= sqrt(norm2(n));
    const Real mu = Real(G ? *G : s.units().G) * s.masses()[0];
    for (Index i = 1; i < s.size(); ++i) {
      const Vec3<Real> d = s.positions()[i] - s.positions()[0];
      // Lengths enter as ratios: a power r^7 would leave the range of doubles at 1e44.
      const Real r = sqrt(norm2(d)), ratio = Real(radius) / r, ratio2 = ratio * ratio;
      const Vec3<Real> e = d / r;
      const Real c = dot(e, n), c2 = c * c;
      const Real k2 = mu / r * Real(J2) / Real(2) * ratio2, k4 = mu / r * Real(J4) / Real(8) * ratio2 * ratio2;
      const Vec3<Real> gradient =
          Real(3) * k2 / r * (Real(2) * c * n + (Real(1) - Real(5) * c2) * e) +
          Real(5) * k4 / r * ((Real(28) * c2 - Real(12)) * c * n + (Real(42) * c2 - Real(63) * c2 * c2 - Real(3)) * e);
      out.acceleration(i, -gradient);
      out.acceleration(0, s.masses()[i] / s.masses()[0] * gradient);
      if (out.wants_energy()) {
        out.energy(s.masses()[i] *
                   (k2 * (Real(3) * c2 - Real(1)) + k4 * (Real(35) * c2 * c2 - Real(30) * c2 + Real(3))));
      }
    }
  }
  /// Its secants between two states.
  template <class Real>
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const {
    detail::add_middle_secants(*this, out, from, to);
  }
};

namespace detail {  // compiled once, in oblateness.cpp

extern template struct ForceModel<Oblateness, double>;
extern template struct ForceModel<Oblateness, Quad>;

}  // namespace detail

}  // namespace noether

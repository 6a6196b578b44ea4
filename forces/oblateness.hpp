#pragma once
/// The zonal harmonics J2 and J4 of an oblate primary.

#include "engine/any_force.hpp"
#include "engine/bodies.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "forces/primary.hpp"
#include "forces/secant.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace noether {

/// What the axis of a figure stands still in.
enum class AxisFrame : std::uint8_t { space, body };

template <> struct EnumNames<AxisFrame> {
  static constexpr std::array<std::pair<AxisFrame, std::string_view>, 2> values = {
      {{AxisFrame::space, "space"}, {AxisFrame::body, "body"}}};
};

/// Field of an oblate primary (particle 0) about an axis n, with the reaction on the primary.
///
///     U = sum_i m_i (G m_0 / r) [J2 (R/r)^2 P2(c) + J4 (R/r)^4 P4(c)],   r = |x_i - x_0|,   c = (x_i - x_0) . n / r
///     torque on 0 = sum_i (x_i - x_0) x dU/dx_i,   for n = R(q) axis, which turns with particle 0
///
/// P2, P4 are Legendre polynomials. Tracers feel it. An axis that is fixed in space has no torque. One that turns with
/// the primary, a rigid body, has that which balances the couple of the forces, which are opposite to the bit: the
/// angular momentum is conserved to rounding. Beside the moments of inertia, to which J2 = (C - A)/(m R^2) belongs,
/// `GravityOfBodies` has J2 already, and takes J4 alone.
/// @cost O(n), no allocation
/// @source MurrayDermott1999
struct Oblateness {
  double J2 = 0.0;                         ///< [1]
  double J4 = 0.0;                         ///< [1]
  double radius = 0.0;                     ///< equatorial radius of the primary [length]
  std::array<double, 3> axis = {0, 0, 1};  ///< direction of the axis; its length does not matter
  std::optional<AxisFrame> frame = {};     ///< default: space; body: `axis` is in the principal axes of particle 0
  std::optional<double> G = {};            ///< [length^3/mass/time^2]; default: the unit system's own
  Primary primary = {};                    ///< particle 0 of the run

  static constexpr auto describe() {
    return part<Oblateness>(
        "oblateness", "zonal harmonics J2 and J4 of particle 0",
        formula("U = sum_i m_i (G m_0/r) [J2 (R/r)^2 P2(c) + J4 (R/r)^4 P4(c)]"), source("MurrayDermott1999"),
        field<&Oblateness::J2>("J2", "1"), field<&Oblateness::J4>("J4", "1"),
        field<&Oblateness::radius>("radius", "length", "equatorial radius of the primary").required("\"60330 km\""),
        field<&Oblateness::axis>("axis", "1", "direction of the axis of symmetry"),
        field<&Oblateness::frame>("frame", "1",
                                  "of the axis: space where it is fixed, the default; body where it turns with "
                                  "particle 0, a rigid body, from whose principal axes it is taken"),
        field<&Oblateness::G>("G", "length^3/mass/time^2", "default: the unit system's own"));
  }

  bool turns() const { return frame == AxisFrame::body; }
  ForceClaims claims() const {
    return {.keeps_angular_momentum = turns(),
            .fixed_figure = !turns(),
            .turning_figures = turns() && J2 != 0,
            .on_bodies = turns(),
            .charges = false,
            .exclusions = false};
  }

  /// @throws Error  without J2 and J4, a radius above 0, or an axis that has a direction
  void check() const;
  /// @throws Error  for a particle 0 without mass, for a rigid one whose axis does not turn, and for a body's axis
  /// where it is none of three moments or a fixed point holds a body
  template <class Real> void check(const ParticleSystem<Real>& s) const {
    primary.check(s, "oblateness");
    if (s.size() == 0) return;
    const int freedoms = has_bodies(s) ? turning_freedoms<Real>(Vec3<Real>(s.template column<BodyInertia>()[0])) : 0;
    check_primary(s.bodies(), s.name(0), freedoms);
  }

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    using std::sqrt;
    Vec3<Real> n{Real(axis[0]), Real(axis[1]), Real(axis[2])};
    n /= sqrt(norm2(n));
    if (turns()) n = to_space<Real>(rotation_matrix<Real>(s.template column<BodyOrientation>()[0]), n);
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
      if (turns()) {
        add_turning(out, s, i, gradient,
                    Vec3<Real>((Real(6) * k2 + Real(5) * k4 * (Real(28) * c2 - Real(12))) * c * cross<Real>(e, n)));
      } else {
        out.acceleration(i, -gradient);
        out.acceleration(0, s.masses()[i] / s.masses()[0] * gradient);
      }
      if (out.wants_energy()) {
        out.energy(s.masses()[i] *
                   (k2 * (Real(3) * c2 - Real(1)) + k4 * (Real(35) * c2 * c2 - Real(30) * c2 + Real(3))));
      }
    }
  }
  /// Secants are between places, not between orientations.
  bool has_secant() const { return !turns(); }
  /// Its secants between two states.
  template <class Real>
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const {
    detail::add_middle_secants(*this, out, from, to);
  }

 private:
  void check_primary(const Bodies* bodies, const std::string& name, int freedoms) const;

  /// @param gradient, turn  of U/m_i: where particle i is, and d x gradient, to which what points along d gives nothing
  template <class Real>
  static void add_turning(ForceSink<Real>& out, const ParticleSystem<Real>& s, Index i, const Vec3<Real>& gradient,
                          const Vec3<Real>& turn) {
    const Real m = s.masses()[i];
    if (m == Real(0)) return out.acceleration(i, -gradient);
    out.pair(i, 0, -m * gradient);
    out.torque(0, m * turn);
  }
};

namespace detail {  // compiled once, in oblateness.cpp

extern template struct ForceModel<Oblateness, double>;
extern template struct ForceModel<Oblateness, Quad>;

}  // namespace detail

}  // namespace noether

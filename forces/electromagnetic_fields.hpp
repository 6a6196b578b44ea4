#pragma once
/// Fields of traps, beams, planets and fusion devices: closed forms of E and B with their potentials.

#include "forces/current_loop.hpp"
#include "forces/electromagnetic_field.hpp"
#include "forces/external_fields.hpp"

#include <array>
#include <cmath>

namespace noether {

namespace detail {
inline constexpr const char* electric_unit = "mass length/charge/time^2";
inline constexpr const char* magnetic_unit = "mass/charge/time";

/// @throws Error  unless it is above 0
inline void expect_above_zero(std::string_view key, double value, const char* what) {
  if (!(value > 0)) refuse_field(key, value, std::string("is not a valid ") + what + "; a number above 0 is expected");
}
}  // namespace detail

/// The same E and B everywhere.
///
///     phi = - E . x,   A = B x x / 2
struct UniformElectromagnetic {
  std::array<double, 3> E = {0, 0, 0};  ///< [mass length/time^2/charge]
  std::array<double, 3> B = {0, 0, 0};  ///< [mass/time/charge]

  static constexpr auto describe() {
    return part<UniformElectromagnetic>(
        "uniform_electromagnetic", "the same electric and magnetic field everywhere",
        formula("E, B constant;  phi = - E . x,  A = B x x / 2"), source("Jackson1999"),
        field<&UniformElectromagnetic::E>("E", detail::electric_unit, "electric field"),
        field<&UniformElectromagnetic::B>("B", detail::magnetic_unit, "magnetic field"));
  }

  template <class Real> void at(const Real& /*t*/, const Vec3<Real>& x, FieldValues<Real>& field) const {
    field.E = detail::widened<Real>(E);
    field.B = detail::widened<Real>(B);
    field.A = cross(field.B, x) / Real(2);
    field.phi = -dot(field.E, x);
  }
};

/// A magnetic field along z that grows along x: charges drift along y.
///
///     B = (B0 + gradient x) e_z,   A = (B0 x + gradient x^2/2) e_y
struct GradientField {
  double B0 = 1.0;        ///< at x = 0 [mass/time/charge]
  double gradient = 0.0;  ///< dB/dx [mass/time/charge/length]

  static constexpr auto describe() {
    return part<GradientField>(
        "magnetic_gradient", "a magnetic field along z that grows along x", formula("B = (B0 + gradient x) e_z"),
        source("Northrop1963"), field<&GradientField::B0>("B0", detail::magnetic_unit, "at x = 0").required("\"1 T\""),
        field<&GradientField::gradient>("gradient", "mass/charge/time/length", "dB/dx").required("\"0.1 T/m\""));
  }

  template <class Real> void at(const Real& /*t*/, const Vec3<Real>& x, FieldValues<Real>& field) const {
    field.B[2] = Real(B0) + Real(gradient) * x[0];
    field.A[1] = x[0] * (Real(B0) + Real(gradient / 2) * x[0]);
  }
};

/// A magnetic mirror: two loops of current about the z axis, at z = -distance/2 and +distance/2.
///
///     B, A by complete elliptic integrals; B0 is what one loop makes at its own center
struct MagneticMirror {
  double B0 = 1.0;        ///< [mass/time/charge]
  double radius = 1.0;    ///< of the loops [length]
  double distance = 2.0;  ///< between them [length]

  static constexpr auto describe() {
    return part<MagneticMirror>(
        "magnetic_mirror", "two loops of current about the z axis, between which charges are reflected",
        formula("B = loop(x, z - d/2) + loop(x, z + d/2)"), source("Jackson1999, Bulirsch1969"),
        field<&MagneticMirror::B0>("B0", detail::magnetic_unit, "of one loop, at its own center").required("\"1 T\""),
        field<&MagneticMirror::radius>("radius", "length", "of the loops").required("\"0.5 m\""),
        field<&MagneticMirror::distance>("distance", "length", "between the loops").required("\"2 m\""));
  }
  /// @throws Error  for a radius that is not above 0
  void check() const { detail::expect_above_zero("radius", radius, "radius"); }

  template <class Real> void at(const Real& /*t*/, const Vec3<Real>& x, FieldValues<Real>& field) const {
    for (const double side : {-0.5, 0.5}) {
      detail::add_loop(Real(B0), Real(radius), Vec3<Real>(x[0], x[1], x[2] - Real(side * distance)), field);
    }
  }
};

/// The field of a magnetic dipole at the origin, of a planet far from it.
///
///     B = (3 (M . x) x - M r^2)/r^5,   A = M x x/r^3
struct MagneticDipole {
  std::array<double, 3> moment = {0, 0, 1};  ///< mu_0/4 pi times the moment [mass length^3/time/charge]

  static constexpr auto describe() {
    return part<MagneticDipole>(
        "magnetic_dipole", "the field of a magnetic dipole at the origin", formula("B = (3 (M.x) x - M r^2)/r^5"),
        source("Jackson1999"),
        field<&MagneticDipole::moment>("moment", "mass length^3/charge/time",
                                       "M: mu_0/4 pi times the moment; |M|/r^3 is B on the equator")
            .required("[\"0 T m^3\", \"0 T m^3\", \"-8e15 T m^3\"]"));
  }

  template <class Real> void at(const Real& /*t*/, const Vec3<Real>& x, FieldValues<Real>& field) const {
    using std::sqrt;
    const Vec3<Real> M = detail::widened<Real>(moment);
    const Real r2 = norm2(x), r3 = r2 * sqrt(r2);
    field.B = (Real(3) * dot(M, x) * x - r2 * M) / (r2 * r3);
    field.A = cross(M, x) / r3;
  }
};

/// An axisymmetric tokamak with circular magnetic surfaces about a ring of radius R0.
///
///     B = (B0/R) (R0 e_phi + (- z e_R + (R - R0) e_z)/q)
///     R A_phi = B0 ((R - R0)^2 + z^2)/2 q,   A_z = - B0 R0 ln(R/R0)
///
/// On the axis of symmetry (R = 0) it is infinite.
struct Tokamak {
  double B0 = 1.0;      ///< on the ring [mass/time/charge]
  double R0 = 1.0;      ///< [length]
  double safety = 2.0;  ///< q: turns around the axis for one about the ring

  static constexpr auto describe() {
    return part<Tokamak>(
        "tokamak", "an axisymmetric tokamak with circular magnetic surfaces",
        formula("B = (B0/R) (R0 e_phi + (- z e_R + (R - R0) e_z)/q)"), source("QinEtAl2009"),
        field<&Tokamak::B0>("B0", detail::magnetic_unit, "on the ring R = R0, z = 0").required("\"1 T\""),
        field<&Tokamak::R0>("R0", "length", "radius of the ring").required("\"1 m\""),
        field<&Tokamak::safety>("safety", "1", "q, turns around the axis for one about the ring"));
  }
  /// @throws Error  for a radius that is not above 0 and a q that is 0
  void check() const {
    detail::expect_above_zero("R0", R0, "radius");
    if (safety == 0) refuse_field("safety", safety, "is not a valid safety factor; a number other than 0 is expected");
  }

  template <class Real> void at(const Real& /*t*/, const Vec3<Real>& x, FieldValues<Real>& field) const {
    using std::log;
    using std::sqrt;
    const Real R2 = x[0] * x[0] + x[1] * x[1], R = sqrt(R2);
    const Real out = R - Real(R0), toroidal = Real(B0) * Real(R0) / R2, poloidal = Real(B0) / (Real(safety) * R);
    field.B = Vec3<Real>(-toroidal * x[1] - poloidal * x[2] * x[0] / R, toroidal * x[0] - poloidal * x[2] * x[1] / R,
                         poloidal * out);
    const Real around = Real(B0) / Real(2 * safety) * (out * out + x[2] * x[2]) / R2;
    field.A = Vec3<Real>(-around * x[1], around * x[0], -Real(B0) * Real(R0) * log(R / Real(R0)));
  }
};

/// An ideal Penning trap: a quadrupole that holds charges along z and a magnetic field that holds them across.
///
///     E = k (x, y, -2 z),   B = B0 e_z,   phi = - k (x^2 + y^2 - 2 z^2)/2
struct PenningTrap {
  double B0 = 1.0;        ///< [mass/time/charge]
  double gradient = 0.0;  ///< k [mass/time^2/charge]

  static constexpr auto describe() {
    return part<PenningTrap>(
        "penning_trap", "a quadrupole that holds charges along z, a magnetic field across",
        formula("E = k (x, y, -2z),  B = B0 e_z"), source("BrownGabrielse1986"),
        field<&PenningTrap::B0>("B0", detail::magnetic_unit, "magnetic field along z").required("\"5 T\""),
        field<&PenningTrap::gradient>("gradient", "mass/charge/time^2", "k, of the electric field across the axis")
            .required("\"1e5 V/m^2\""));
  }

  template <class Real> void at(const Real& /*t*/, const Vec3<Real>& x, FieldValues<Real>& field) const {
    const Real k(gradient), B(B0);
    field.E = Vec3<Real>(k * x[0], k * x[1], Real(-2) * k * x[2]);
    field.B[2] = B;
    field.A = Vec3<Real>(-B * x[1] / Real(2), B * x[0] / Real(2), Real(0));
    field.phi = -k / Real(2) * (x[0] * x[0] + x[1] * x[1] - Real(2) * x[2] * x[2]);
  }
};

/// A plane wave, linearly polarized.
///
///     E = E0 cos(w),  B = n x E/c,  A = (E0/omega) sin(w),  w = omega (n . x/c - t) + phase,  n . E0 = 0
///
/// The potential is that of A alone; the energy that reports show is the kinetic one.
struct PlaneWave {
  std::array<double, 3> E0 = {0, 0, 0};         ///< amplitude [mass length/time^2/charge]
  std::array<double, 3> direction = {0, 0, 1};  ///< along n, of any length
  double omega = 1.0;                           ///< [1/time]
  double c = 1.0;                               ///< speed of light [length/time]
  double phase = 0.0;                           ///< [angle]

  static constexpr auto describe() {
    return part<PlaneWave>("plane_wave", "a plane electromagnetic wave, linearly polarized",
                           formula("E = E0 cos(omega (n.x/c - t) + phase),  B = n x E/c"), source("Jackson1999"),
                           field<&PlaneWave::E0>("E0", detail::electric_unit, "amplitude, across the direction")
                               .required("[\"1e9 V/m\", \"0 V/m\", \"0 V/m\"]"),
                           field<&PlaneWave::direction>("direction", "1", "n, in which it goes, of any length"),
                           field<&PlaneWave::omega>("omega", "1/time", "angular frequency").required("\"2e15/s\""),
                           field<&PlaneWave::c>("c", "length/time", "speed of light").required("\"299792458 m/s\""),
                           field<&PlaneWave::phase>("phase", "angle"));
  }
  static constexpr ElectromagneticClaims field_claims() { return {.time_dependent = true}; }
  /// @throws Error  for a direction without length, and for an amplitude that is not across it
  void check() const {
    detail::expect_above_zero("omega", omega, "frequency");
    detail::expect_above_zero("c", c, "speed of light");
    const Vec3<double> n = detail::widened<double>(direction), E = detail::widened<double>(E0);
    if (!(norm2(n) > 0)) refuse_field("direction", direction, "has no length; a direction is expected");
    if (std::abs(dot(n, E)) > 1e-12 * std::sqrt(norm2(n) * norm2(E))) {
      refuse_field("E0", E0, "is not across the direction of the wave; E0 . direction = 0 is expected");
    }
  }

  template <class Real> void at(const Real& t, const Vec3<Real>& x, FieldValues<Real>& field) const {
    using std::cos;
    using std::sin;
    using std::sqrt;
    Vec3<Real> n = detail::widened<Real>(direction);
    n /= sqrt(norm2(n));
    const Real w = Real(omega) * (dot(n, x) / Real(c) - t) + Real(phase);
    const Vec3<Real> amplitude = detail::widened<Real>(E0);
    field.E = cos(w) * amplitude;
    field.B = cross(n, field.E) / Real(c);
    field.A = sin(w) / Real(omega) * amplitude;
  }
};

/// The gap between two drift tubes of an accelerator, in which a field along z oscillates; right to first order in the
/// distance r from the axis.
///
///     E_z = E0 g cos(w),  E_r = - E0 g' r cos(w)/2,  B_phi = - E0 omega r g sin(w)/2 c^2,
///     g = exp(- z^2/length^2),  w = omega t + phase
struct RadioFrequencyGap {
  double E0 = 0.0;      ///< on the axis, in the middle of the gap [mass length/time^2/charge]
  double length = 1.0;  ///< [length]
  double omega = 1.0;   ///< [1/time]
  double c = 1.0;       ///< speed of light [length/time]
  double phase = 0.0;   ///< [angle]

  static constexpr auto describe() {
    return part<RadioFrequencyGap>(
        "radio_frequency_gap", "the gap of an accelerator, in which a field along z oscillates",
        formula("E_z = E0 exp(-z^2/length^2) cos(omega t + phase), E_r and B_phi to first order in r"),
        source("Wangler2008"),
        field<&RadioFrequencyGap::E0>("E0", detail::electric_unit, "in the middle of the gap").required("\"10e6 V/m\""),
        field<&RadioFrequencyGap::length>("length", "length", "of the gap: g = exp(- z^2/length^2)")
            .required("\"2 cm\""),
        field<&RadioFrequencyGap::omega>("omega", "1/time", "angular frequency").required("\"8e9/s\""),
        field<&RadioFrequencyGap::c>("c", "length/time", "speed of light").required("\"299792458 m/s\""),
        field<&RadioFrequencyGap::phase>("phase", "angle"));
  }
  static constexpr ElectromagneticClaims field_claims() { return {.vector_potential = false, .time_dependent = true}; }
  /// @throws Error  for a length or c that is not above 0
  void check() const {
    detail::expect_above_zero("length", length, "length");
    detail::expect_above_zero("c", c, "speed of light");
  }

  template <class Real> void at(const Real& t, const Vec3<Real>& x, FieldValues<Real>& field) const {
    using std::cos;
    using std::exp;
    using std::sin;
    const Real u = x[2] / Real(length), g = Real(E0) * exp(-u * u), w = Real(omega) * t + Real(phase);
    const Real wave = cos(w), sideways = g * u / Real(length) * wave;  // - g'/2
    const Real around = -Real(omega) / (Real(2) * Real(c) * Real(c)) * g * sin(w);
    field.E = Vec3<Real>(sideways * x[0], sideways * x[1], g * wave);
    field.B = Vec3<Real>(-around * x[1], around * x[0], Real(0));
  }
};

namespace detail {  // compiled once, in electromagnetic_fields.cpp

#define NOETHER_FIELD(FIELD)                                 \
  extern template struct ForceModel<InField<FIELD>, double>; \
  extern template struct ForceModel<InField<FIELD>, Quad>;
NOETHER_FIELD(UniformElectromagnetic)
NOETHER_FIELD(GradientField)
NOETHER_FIELD(MagneticMirror)
NOETHER_FIELD(MagneticDipole)
NOETHER_FIELD(Tokamak)
NOETHER_FIELD(PenningTrap)
NOETHER_FIELD(PlaneWave)
NOETHER_FIELD(RadioFrequencyGap)
#undef NOETHER_FIELD

}  // namespace detail

}  // namespace noether

#pragma once
/// Fields that do not come from particles: uniform, oscillating, harmonic.

#include "engine/any_force.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "forces/secant.hpp"

#include <array>
#include <cmath>

namespace noether {

namespace detail {
template <class Real> Vec3<Real> widened(const std::array<double, 3>& a) {
  return Vec3<Real>(Real(a[0]), Real(a[1]), Real(a[2]));
}
}  // namespace detail

/// The same acceleration everywhere.
///
///     U = - sum_i m_i g . x_i
struct UniformField {
  std::array<double, 3> acceleration = {0, 0, 0};  ///< g [length/time^2]

  static constexpr auto describe() {
    return part<UniformField>(
        "uniform_field", "the same acceleration everywhere", formula("U = - sum_i m_i g . x_i"),
        field<&UniformField::acceleration>("acceleration", "length/time^2", "the acceleration, g = [x, y, z]")
            .required("[\"0 m/s^2\", \"0 m/s^2\", \"-9.81 m/s^2\"]"));
  }
  static ForceClaims claims() {
    return {.keeps_momentum = false,
            .keeps_angular_momentum = false,
            .periodic = true,
            .charges = false,
            .exclusions = false,
            .tangent = TangentPattern::sparse};
  }

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const Vec3<Real> g = detail::widened<Real>(acceleration);
    for (Index i = 0; i < s.size(); ++i) {
      out.acceleration(i, g);
      if (out.wants_energy()) out.energy(-s.masses()[i] * dot(g, s.unwrapped(i)));
    }
  }
  /// Its secants between two states, the same wherever they are.
  template <class Real>
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const {
    detail::add_middle_secants(*this, out, from, to);
  }
};

/// A uniform acceleration that oscillates; the forces of a stage see the time of that stage.
///
///     U = - sum_i m_i g . x_i cos(omega t + phase)
struct OscillatingField {
  std::array<double, 3> acceleration = {0, 0, 0};  ///< g [length/time^2]
  double omega = 0.0;                              ///< angular frequency [1/time]
  double phase = 0.0;                              ///< [angle]

  static constexpr auto describe() {
    return part<OscillatingField>(
        "oscillating_field", "a uniform acceleration that oscillates in time",
        formula("U = - sum_i m_i g . x_i cos(omega t + phase)"),
        field<&OscillatingField::acceleration>("acceleration", "length/time^2",
                                               "amplitude of the acceleration, g = [x, y, z]")
            .required("[\"0 m/s^2\", \"0 m/s^2\", \"-9.81 m/s^2\"]"),
        field<&OscillatingField::omega>("omega", "1/time", "angular frequency").required("\"0.1/day\""),
        field<&OscillatingField::phase>("phase", "angle"));
  }
  static ForceClaims claims() {
    return {.time_dependent = true,
            .keeps_momentum = false,
            .keeps_angular_momentum = false,
            .periodic = true,
            .charges = false,
            .exclusions = false};
  }

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    using std::cos;
    const Vec3<Real> g = cos(Real(omega) * s.time() + Real(phase)) * detail::widened<Real>(acceleration);
    for (Index i = 0; i < s.size(); ++i) {
      out.acceleration(i, g);
      if (out.wants_energy()) out.energy(-s.masses()[i] * dot(g, s.unwrapped(i)));
    }
  }
};

/// A spring to the origin for every particle that has mass.
///
///     U = sum_i k |x_i|^2 / 2
struct HarmonicField {
  double k = 0.0;  ///< [mass/time^2]

  static constexpr auto describe() {
    return part<HarmonicField>(
        "harmonic_field", "a spring to the origin for every massive particle", formula("U = sum_i k |x_i|^2 / 2"),
        source("Hooke1678"),
        field<&HarmonicField::k>("k", "mass/time^2", "stiffness of the spring").required("\"1 kg/s^2\""));
  }
  static ForceClaims claims() {
    return {.keeps_momentum = false, .charges = false, .exclusions = false, .tangent = TangentPattern::sparse};
  }

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> x = s.positions()[i];
      out.force(i, -Real(k) * x);
      if (out.wants_energy() && s.masses()[i] != Real(0)) out.energy(Real(k) * norm2(x) / Real(2));
    }
  }
  /// Its secants between two states.
  template <class Real>
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const {
    detail::add_middle_secants(*this, out, from, to);
    const Mat3<Real> derivative = -Real(k) / Real(2) * Mat3<Real>::Identity();
    for (Index i = 0; i < to.size() && out.tangent() != nullptr; ++i) out.tangent()->force(i, i, derivative);
  }
};

namespace detail {  // compiled once, in external_fields.cpp

extern template struct ForceModel<UniformField, double>;
extern template struct ForceModel<UniformField, Quad>;
extern template struct ForceModel<OscillatingField, double>;
extern template struct ForceModel<OscillatingField, Quad>;
extern template struct ForceModel<HarmonicField, double>;
extern template struct ForceModel<HarmonicField, Quad>;

}  // namespace detail

}  // namespace noether

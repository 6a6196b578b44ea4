#pragma once
/// The forces of a frame that turns on a circular orbit, in Hill's approximation.

#include "engine/any_force.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"

namespace noether {

/// Tidal and Coriolis forces in a frame on a circular orbit, x away from the primary, y along the motion.
///
///     x'' = 2 Omega y' + 3 Omega^2 x,   y'' = - 2 Omega x',   z'' = - Omega_z^2 z
///     U = sum_i m_i (Omega_z^2 z_i^2 - 3 Omega^2 x_i^2)/2
///
/// @source Hill1878
struct HillFrame {
  double Omega = 1;    ///< angular velocity of the frame [1/time]
  double Omega_z = 1;  ///< of oscillations across the plane [1/time]

  static constexpr auto describe() {
    return part<HillFrame>(
        "hill_frame", "tidal and Coriolis forces of a frame on a circular orbit",
        formula("x'' = 2 Omega y' + 3 Omega^2 x,  y'' = - 2 Omega x',  z'' = - Omega_z^2 z"), source("Hill1878"),
        field<&HillFrame::Omega>("Omega", "1/time", "angular velocity of the frame"),
        field<&HillFrame::Omega_z>("Omega_z", "1/time", "angular velocity of oscillations across the plane"));
  }
  static ForceClaims claims() {
    return {.virial = false,
            .velocity_dependent = true,
            .keeps_momentum = false,
            .keeps_angular_momentum = false,
            .charges = false,
            .exclusions = false};
  }

  template <class Real> Vec3<Real> acceleration(const Vec3<Real>& x, const Vec3<Real>& v) const {
    const Real w(Omega), wz(Omega_z);
    return Vec3<Real>(Real(2) * w * v[1] + Real(3) * w * w * x[0], Real(-2) * w * v[0], -wz * wz * x[2]);
  }
  /// For each unit of mass.
  template <class Real> Real potential(const Vec3<Real>& x) const {
    const Real w(Omega), wz(Omega_z);
    return (wz * wz * x[2] * x[2] - Real(3) * w * w * x[0] * x[0]) / Real(2);
  }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> x = s.positions()[i], v = s.velocities()[i];
      out.acceleration(i, acceleration(x, v));
      if (out.wants_energy()) out.energy(s.masses()[i] * potential(x));
    }
  }
};

}  // namespace noether

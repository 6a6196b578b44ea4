#pragma once
/// The potential of Henon and Heiles: the smallest problem with regular and irregular motion side by side.

#include "engine/any_force.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "forces/secant.hpp"

namespace noether {

/// A well in the plane with three saddles, on every particle by itself.
///
///     U = sum_i m_i omega^2 [ (x^2 + y^2)/2 + (x^2 y - y^3/3)/l ]
///
/// Motion is bounded below m omega^2 l^2 / 6, mostly regular below half of that, mostly irregular above.
/// @source HenonHeiles1964
struct HenonHeiles {
  double omega = 1.0;   ///< of small oscillations [1/time]
  double length = 1.0;  ///< l, from the well to each saddle [length]

  static constexpr auto describe() {
    return part<HenonHeiles>("henon_heiles", "a well in the plane with three saddles, for each particle separately",
                             formula("U = sum_i m_i omega^2 [ (x^2 + y^2)/2 + (x^2 y - y^3/3)/length ]"),
                             source("HenonHeiles1964"),
                             field<&HenonHeiles::omega>("omega", "1/time", "angular frequency of small oscillations"),
                             field<&HenonHeiles::length>("length", "length", "distance from the well to each saddle"));
  }

  static ForceClaims claims() {
    return {.keeps_momentum = false, .keeps_angular_momentum = false, .charges = false, .exclusions = false};
  }

  /// @throws Error  for a length that is not above 0
  void check() const {
    if (!(length > 0))
      refuse_field("length", length, "is not a valid distance to the saddles; a length above 0 is expected");
  }

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const Real w2 = Real(omega) * Real(omega), l(length);
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> q = s.positions()[i];
      const Real x = q[0], y = q[1];
      out.acceleration(i, w2 * Vec3<Real>(-x - Real(2) * x * y / l, -y - (x * x - y * y) / l, Real(0)));
      if (!out.wants_energy()) continue;
      out.energy(s.masses()[i] * w2 * ((x * x + y * y) / Real(2) + (x * x * y - y * y * y / Real(3)) / l));
    }
  }
  /// Its secants between two states.
  template <class Real>
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const {
    detail::add_middle_secants(*this, out, from, to);
  }
};

namespace detail {  // compiled once, in henon_heiles.cpp

extern template struct ForceModel<HenonHeiles, double>;
extern template struct ForceModel<HenonHeiles, Quad>;

}  // namespace detail

}  // namespace noether

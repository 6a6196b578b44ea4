#pragma once
/// The chain of Fermi, Pasta and Ulam with stiff and soft springs in turn: fast oscillators that trade energy slowly.

#include "engine/any_force.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "forces/secant.hpp"

namespace noether {

/// Particles in a row between two walls, soft quartic springs and stiff harmonic ones in turn, a soft one first.
///
///     U = sum over links of even number quartic d^4 + sum over links of odd number k d^2 / 2,
///     d_l = q_{l+1} - q_l,  l = 0, ..., n,  q_0 = q_{n+1} = 0
///
/// The q are displacements along x of the particles in their order; y and z feel nothing. Each pair joined by a stiff
/// spring oscillates with omega = sqrt(2 k / m); energy goes from pair to pair over times of omega, while the sum of
/// the oscillatory energies stays near where it was. In the form of the source, with m = 1: k = omega^2 / 2 and
/// quartic = 1.
/// @source HairerLubichWanner2006
struct FermiPastaUlam {
  double k = 0.0;        ///< of the stiff springs [mass/time^2]
  double quartic = 1.0;  ///< of the soft ones [mass/length^2/time^2]

  static constexpr auto describe() {
    return part<FermiPastaUlam>(
        "fermi_pasta_ulam", "a row of particles between walls, soft quartic springs and stiff ones in turn, along x",
        formula("U = sum_{even l} quartic d_l^4 + sum_{odd l} k d_l^2 / 2,  d_l = q_{l+1} - q_l,  q_0 = q_{n+1} = 0"),
        source("HairerLubichWanner2006"),
        field<&FermiPastaUlam::k>("k", "mass/time^2", "stiffness of the stiff springs").required("\"1 kg/s^2\""),
        field<&FermiPastaUlam::quartic>("quartic", "mass/length^2/time^2", "stiffness of the soft springs"));
  }
  static ForceClaims claims() {
    return {.keeps_momentum = false, .keeps_angular_momentum = false, .charges = false, .exclusions = false};
  }

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const Index n = s.size();
    for (Index l = 0; l <= n; ++l) {
      const Real before = l > 0 ? s.positions()[l - 1][0] : Real(0), after = l < n ? s.positions()[l][0] : Real(0);
      const Real d = after - before;
      const bool stiff = l % 2 == 1;
      const Real pull = stiff ? Real(k) * d : Real(4) * Real(quartic) * d * d * d;
      if (l > 0) out.force(l - 1, Vec3<Real>(pull, Real(0), Real(0)));
      if (l < n) out.force(l, Vec3<Real>(-pull, Real(0), Real(0)));
      if (out.wants_energy()) out.energy(stiff ? Real(k) * d * d / Real(2) : Real(quartic) * d * d * d * d);
    }
  }
  /// Its secants between two states.
  template <class Real>
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const {
    detail::add_middle_secants(*this, out, from, to);
  }
};

namespace detail {  // compiled once, in fermi_pasta_ulam.cpp

extern template struct ForceModel<FermiPastaUlam, double>;
extern template struct ForceModel<FermiPastaUlam, Quad>;

}  // namespace detail

}  // namespace noether

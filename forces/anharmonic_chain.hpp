#pragma once
/// Particles in a row between walls, on equal springs that are not linear.

#include "engine/any_force.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "forces/secant.hpp"

namespace noether {

/// The chain that Fermi, Pasta and Ulam let run: does the energy of one wave spread over all of them?
///
///     U = sum over links k d^2 / 2 + cubic d^3 / 3 + quartic d^4 / 4,
///     d_l = q_{l+1} - q_l,  l = 0, ..., n,  q_0 = q_{n+1} = 0
///
/// The q are displacements along x of the particles in their order; y and z feel nothing. The waves of the linear
/// chain, q_i = sin(j pi i / (n + 1)), have omega = 2 sqrt(k / m) sin(j pi / (2 (n + 1))). With a cubic term alone U
/// has no bottom: a chain that is stretched far runs away.
/// @source FermiPastaUlam1955
struct AnharmonicChain {
  double k = 0.0;        ///< stiffness of a spring at rest [mass/time^2]
  double cubic = 0.0;    ///< alpha [mass/length/time^2]
  double quartic = 0.0;  ///< beta [mass/length^2/time^2]

  static constexpr auto describe() {
    return part<AnharmonicChain>(
        "anharmonic_chain", "a row of particles between walls, on equal springs that are not linear, along x",
        formula("U = sum_l k d_l^2 / 2 + cubic d_l^3 / 3 + quartic d_l^4 / 4,  d_l = q_{l+1} - q_l,  "
                "q_0 = q_{n+1} = 0"),
        source("FermiPastaUlam1955"),
        field<&AnharmonicChain::k>("k", "mass/time^2", "stiffness of a spring at rest").required("\"1 kg/s^2\""),
        field<&AnharmonicChain::cubic>("cubic", "mass/length/time^2", "the alpha of the source"),
        field<&AnharmonicChain::quartic>("quartic", "mass/length^2/time^2", "the beta of the source"));
  }
  static ForceClaims claims() {
    return {.keeps_momentum = false, .keeps_angular_momentum = false, .charges = false, .exclusions = false};
  }

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const Real third = Real(cubic) / Real(3), fourth(quartic / 4), half(k / 2);
    const Index n = s.size();
    for (Index l = 0; l <= n; ++l) {
      const Real before = l > 0 ? s.positions()[l - 1][0] : Real(0), after = l < n ? s.positions()[l][0] : Real(0);
      const Real d = after - before, pull = d * (Real(k) + d * (Real(cubic) + d * Real(quartic)));
      if (l > 0) out.force(l - 1, Vec3<Real>(pull, Real(0), Real(0)));
      if (l < n) out.force(l, Vec3<Real>(-pull, Real(0), Real(0)));
      if (out.wants_energy()) out.energy(d * d * (half + d * (third + d * fourth)));
    }
  }
  /// Its secants between two states.
  template <class Real>
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const {
    detail::add_middle_secants(*this, out, from, to);
  }
};

namespace detail {  // compiled once, in anharmonic_chain.cpp

extern template struct ForceModel<AnharmonicChain, double>;
extern template struct ForceModel<AnharmonicChain, Quad>;

}  // namespace detail

}  // namespace noether

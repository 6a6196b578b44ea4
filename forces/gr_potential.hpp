#pragma once
/// General relativity about a star, as a potential.

#include "engine/any_force.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "forces/secant.hpp"
#include "forces/speed_of_light.hpp"

#include <optional>

namespace noether {

/// The advance of pericentres that general relativity gives about a dominant primary (particle 0), by a potential, with
/// the reaction on the primary.
///
///     U = - sum_i 3 m_i (G m_0)^2 / (c^2 r^2),   r = |x_i - x_0|
///
/// It depends on positions only, so that every method takes it. Advances of pericentres are those of the first
/// post-Newtonian order; the mean motion is not: on a circle n^2 r^3 = mu (1 + 6 mu/(c^2 r)), mu = G m_0, where general
/// relativity has mu (1 - 3 mu/(c^2 r)) in harmonic coordinates (`PostNewtonian`). Tracers feel it.
/// @cost O(n), no allocation
/// @source NobiliRoxburgh1986
struct GrPotential {
  std::optional<double> c = {};  ///< speed of light [length/time]; default: by the unit system
  std::optional<double> G = {};  ///< [length^3/mass/time^2]; default: the unit system's own
  Primary primary = {};          ///< particle 0 of the run

  static constexpr auto describe() {
    return part<GrPotential>("gr_potential",
                             "general relativity of particle 0 as a potential: right pericentres, for every method",
                             formula("U = - sum_i 3 m_i (G m_0)^2/(c^2 r_i^2)"), source("NobiliRoxburgh1986"),
                             speed_of_light_field<GrPotential>(), gravitation_field<GrPotential>());
  }
  /// Why it does not stand twice in a scene.
  static constexpr std::string_view only_once = relativity_only_once;
  /// It takes particle 0 for the heaviest one.
  static constexpr bool about_heaviest = true;

  static ForceClaims claims() { return {.charges = false, .exclusions = false, .tangent = TangentPattern::sparse}; }

  /// @throws Error  for a G or c that is not above 0
  void check() const { check_relativity(*this); }
  /// @throws Error  where neither the force nor the units say what c is, and for a particle 0 without mass
  template <class Real> void check(const ParticleSystem<Real>& s) const { check_relativity(*this, s, "gr_potential"); }

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const Real mu = mu_of_primary(*this, s), light = speed_of_light_in(s, c, "gr_potential");
    const Real k = Real(3) * (mu / light) * (mu / light);
    for (Index i = 1; i < s.size(); ++i) {
      const Vec3<Real> d = s.positions()[i] - s.positions()[0];
      const Real r2 = norm2(d);
      const Vec3<Real> a = -(Real(2) * k / (r2 * r2)) * d;
      out.acceleration(i, a);
      out.acceleration(0, Vec3<Real>(-(s.masses()[i] / s.masses()[0]) * a));
      if (out.wants_energy()) out.energy(-s.masses()[i] * k / r2);
    }
  }
  /// Its secants between two states.
  template <class Real>
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const {
    const Real mu = mu_of_primary(*this, to), light = speed_of_light_in(to, c, "gr_potential");
    const Real k = Real(3) * (mu / light) * (mu / light) / to.masses()[0];
    Secants<Real> secants(out, from, to);
    for (Index i = 1; i < to.size(); ++i) {
      secants.pair({.i = i, .j = 0, .of_masses = true}, [&](const Real& r2) {
        return PairTerms<Real>{-k / r2, Real(-2) * k / (r2 * r2)};
      });
    }
  }
};

namespace detail {  // compiled once, in gr_potential.cpp

extern template struct ForceModel<GrPotential, double>;
extern template struct ForceModel<GrPotential, Quad>;

}  // namespace detail

}  // namespace noether

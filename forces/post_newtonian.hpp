#pragma once
/// General relativity about a star, to the first post-Newtonian order.

#include "engine/any_force.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "forces/speed_of_light.hpp"

#include <optional>

namespace noether {

/// The first post-Newtonian acceleration about a dominant primary (particle 0) in harmonic coordinates, with the
/// reaction on the primary.
///
///     a_i = mu/(c^2 r^3) [(4 mu/r - v^2) d + 4 (d . v) v],   d = x_i - x_0, v = v_i - v_0, mu = G m_0
///
/// Pericentres and mean motions are right to first order in mu/(c^2 r), for bodies that are light beside the primary.
/// It depends on velocities: methods for q'' = f(t, q, v) take it, and of splittings `wisdom_holman`, whose kicks by it
/// are steps of the implicit midpoint rule. Tracers feel it.
/// @cost O(n), no allocation
/// @source AndersonEtAl1975
struct PostNewtonian {
  std::optional<double> c = {};  ///< speed of light [length/time]; default: by the unit system
  std::optional<double> G = {};  ///< [length^3/mass/time^2]; default: the unit system's own
  Primary primary = {};          ///< particle 0 of the run

  static constexpr auto describe() {
    return part<PostNewtonian>(
        "post_newtonian", "general relativity of particle 0 to first order, for methods of y' = f and wisdom_holman",
        formula("a_i = mu/(c^2 r^3) [(4 mu/r - v^2) d + 4 (d.v) v],  d = x_i - x_0, v = v_i - v_0, mu = G m_0"),
        source("AndersonEtAl1975"), speed_of_light_field<PostNewtonian>(), gravitation_field<PostNewtonian>());
  }
  /// Why it does not stand twice in a scene.
  static constexpr std::string_view only_once = relativity_only_once;
  /// It takes particle 0 for the heaviest one.
  static constexpr bool about_heaviest = true;

  static ForceClaims claims() {
    return {.energy = false,
            .velocity_dependent = true,
            .keeps_angular_momentum = false,
            .charges = false,
            .exclusions = false};
  }

  /// @throws Error  for a G or c that is not above 0
  void check() const { check_relativity(*this); }
  /// @throws Error  where neither the force nor the units say what c is, and for a particle 0 without mass
  template <class Real> void check(const ParticleSystem<Real>& s) const {
    check_relativity(*this, s, "post_newtonian");
  }

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    using std::sqrt;
    const Real mu = mu_of_primary(*this, s), light = speed_of_light_in(s, c, "post_newtonian");
    for (Index i = 1; i < s.size(); ++i) {
      const Vec3<Real> d = s.positions()[i] - s.positions()[0];
      const Vec3<Real> v = (s.velocities()[i] - s.velocities()[0]) / light;
      const Real r2 = norm2(d), r = sqrt(r2);
      const Real depth = mu / (r * light * light);  // of the potential, in units of c^2
      const Vec3<Real> a = mu / (r2 * r) * ((Real(4) * depth - norm2(v)) * d + Real(4) * dot(d, v) * v);
      out.acceleration(i, a);
      out.acceleration(0, Vec3<Real>(-(s.masses()[i] / s.masses()[0]) * a));
    }
  }
};

namespace detail {  // compiled once, in post_newtonian.cpp

extern template struct ForceModel<PostNewtonian, double>;
extern template struct ForceModel<PostNewtonian, Quad>;

}  // namespace detail

}  // namespace noether

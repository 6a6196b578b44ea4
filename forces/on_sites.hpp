#pragma once
/// Forces on the sites of rigid bodies, gathered as forces on their centres and torques about them.

#include "engine/sites.hpp"
#include "forces/sum.hpp"

#include <string>
#include <type_traits>
#include <utility>

namespace noether {

/// A sum of forces that acts on the sites of bodies and on the points beside them, as a force on the bodies:
///
///     f_i = sum_a f_a,   torque_i = sum_a R_i d_a x f_a,   W = sum_i X_i (x) f_i
///
/// over the sites a of body i at X_i + R_i d_a. Any force can act this way; what it keeps, such as a neighbor list of
/// the sites, is in the workspace.
/// @cost that of the forces on the sites, and two passes over them
template <class Real> class OnSites {
 public:
  explicit OnSites(ForceField<Real> forces) : forces_(std::move(forces)) {}

  std::string name() const { return "on_sites"; }
  std::string signature() const { return "on_sites(" + forces_.signature() + ")"; }
  ForceClaims claims() const {
    ForceClaims claims = forces_.claims();
    claims.sets = claims.kepler = claims.fixed_figure = false;
    claims.on_bodies = true;
    claims.range = 0;  // of centres: sites have a list of their own
    return claims;
  }
  /// @throws Error  for a force between particles that does not leave out pairs within a body, though there are such,
  /// and for one that gives particle 0 a figure that does not turn, though that is a body
  template <class Number> void check(const ParticleSystem<Number>& s) const {
    if constexpr (std::is_same_v<Number, Real>) {
      check_pairs(s);
      forces_.check(Sites<Real>(s).particles());
    }
  }
  template <class Number> void bind(const ParticleSystem<Number>& s) {
    if constexpr (std::is_same_v<Number, Real>) {
      forces_.bind(Sites<Real>(s).particles());
    }
  }
  void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const;
  /// Eight systems side by side, where all forces can be evaluated so.
  bool has_lanes() const { return forces_.has_lanes(); }
  void add_to(ForceSink<Pack>& out, const ParticleSystem<Pack>& s) const;
  /// With derivatives, where all forces have them.
  bool has_derivative() const { return forces_.has_derivative(); }
  void add_to(ForceSink<Dual<Real, 1>>& out, const ParticleSystem<Dual<Real, 1>>& s) const;
  const ForceField<Real>& forces() const { return forces_; }

 private:
  template <class Number> void add(ForceSink<Number>& out, const ParticleSystem<Number>& s) const;
  void check_pairs(const ParticleSystem<Real>& s) const;

  ForceField<Real> forces_;
};

extern template class OnSites<double>;
extern template class OnSites<Quad>;

namespace detail {  // compiled once, in on_sites.cpp

extern template struct ForceModel<OnSites<double>, double>;
extern template struct ForceModel<OnSites<Quad>, Quad>;

}  // namespace detail

}  // namespace noether

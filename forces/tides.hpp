#pragma once
/// Tides of rigid bodies: bulges that lag, turn the spins that carry them, and move the bodies that raise them.

#include "engine/any_force.hpp"
#include "engine/bodies.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "engine/sphere_columns.hpp"

#include <optional>
#include <string_view>
#include <type_traits>

namespace noether {

/// The potential Love number k2 of a body, shape (n); 0: it has no tides.
struct LoveNumber {
  template <class Real> using type = ScalarColumn<Real>;
  static constexpr std::string_view name = "love_number", dimension = "1";
  static constexpr ColumnRole role = ColumnRole::parameter;
};

/// By how long the tides of a body lag, shape (n) [time].
struct TideLag {
  template <class Real> using type = ScalarColumn<Real>;
  static constexpr std::string_view name = "tide_lag", dimension = "time";
  static constexpr ColumnRole role = ColumnRole::parameter;
};

/// Tides of a constant time lag: every mass j raises a bulge on every body i that has a Love number, where it was tau
/// ago as the body sees it, and the bulge pulls it.
///
///     force on j  = - f [(1 + 2 tau r.v/r^2) r + tau (v - Omega x r)],   f = 3 G k2 m_j^2 R^5/r^8,   r = x_j - x_i
///     torque on i = - r x (force on j),   v = v_j - v_i,   Omega the angular velocity of i
///
/// To first order in tau. The force on i is opposite, so momentum and angular momentum, spins included, are kept. The
/// energy has the potential of bulges that do not lag, - G k2 m_j^2 R^5/(2 r^6); what is lost is what lags. A bulge
/// pulls only who raised it. Bodies with tides turn, so they are rigid bodies with moments; masses that raise tides
/// may be points.
/// @cost O(n) for each body with tides
/// @source Mignard1979, Hut1981
struct Tides {
  std::optional<double> G = {};  ///< [length^3/mass/time^2]; default: the unit system's own

  static constexpr auto describe() {
    return part<Tides>(
        "tides", "tides of rigid bodies with a constant time lag: the dissipative letter T",
        formula("force on j = - f [(1 + 2 tau r.v/r^2) r + tau (v - Omega x r)],  f = 3 G k2 m_j^2 R^5/r^8;  k2 = "
                "love_number, R = radius, tau = tide_lag of i"),
        source("Mignard1979, Hut1981"), letter('T', "step of the implicit midpoint rule of the tides"),
        field<&Tides::G>("G", "length^3/mass/time^2", "default: the unit system's own"));
  }
  using columns = ColumnList<LoveNumber, BodyRadius, TideLag>;
  /// Why it does not stand twice in a scene.
  static constexpr std::string_view only_once = "so every tide would be raised twice; take one of them out";

  static ForceClaims claims() {
    return {.velocity_dependent = true, .dissipative = true, .on_bodies = true, .charges = false, .exclusions = false};
  }

  /// @throws Error  for a G that is not above 0
  void check() const;
  /// @throws Error  where no body has tides, for one without radius or three moments, for numbers below 0, and where a
  /// fixed point holds a body
  template <class Real> void check(const ParticleSystem<Real>& s) const;

  /// Accelerations and torques at the velocities and spins that the particles have.
  template <class Real>
    requires(std::is_same_v<Real, double> || std::is_same_v<Real, Quad>)
  void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const;
};

namespace detail {  // compiled once, in tides.cpp

extern template struct ForceModel<Tides, double>;
extern template struct ForceModel<Tides, Quad>;

}  // namespace detail

}  // namespace noether

#pragma once
/// The monitor of resonances of mean motions.

#include "engine/monitor.hpp"
#include "engine/orbital_elements.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// Watches the angle of a resonance p + q : p of two bodies about a primary,
///
///     phi = (p + q) lambda_outer - p lambda_inner - q varpi,   lambda = Omega + omega + M,   varpi = Omega + omega
///
/// with the pericenter of one of the two. It librates where it stays about a center, with an amplitude below pi; from
/// look to look it is followed along the shorter way, so that looks must be closer than half its period.
/// @cost O(1)
/// @source MurrayDermott1999
class ResonanceAngle {
 public:
  std::vector<std::string> bodies = {};  ///< inner and outer, by name
  std::int64_t p = 1, q = 1;
  std::string pericenter = {};   ///< whose; default: that of the outer body
  std::string about = {};        ///< name of the primary; default: the first particle
  std::optional<double> G = {};  ///< [length^3/mass/time^2]; default: the unit system's own

  ResonanceAngle() = default;
  ResonanceAngle(std::string inner, std::string outer, std::int64_t first, std::int64_t order)
      : bodies{std::move(inner), std::move(outer)}, p(first), q(order) {}

  static constexpr bool needs_particles = true;

  static constexpr auto describe() {
    return part<ResonanceAngle>(
        "resonance_angle", "the angle of a resonance p + q : p of two bodies, and whether it librates",
        formula("phi = (p + q) lambda_outer - p lambda_inner - q varpi"),
        quantities("value [angle], center, amplitude of all since the start [angle]"), source("MurrayDermott1999"),
        field<&ResonanceAngle::bodies>("bodies", "1", "names of the inner and the outer body")
            .required("[\"Neptune\", \"Pluto\"]"),
        field<&ResonanceAngle::p>("p", "1", "revolutions of the outer body while the inner one has p + q"),
        field<&ResonanceAngle::q>("q", "1", "order of the resonance; 0 for bodies that share an orbit"),
        field<&ResonanceAngle::pericenter>("pericenter", "1",
                                           "name of the one whose pericenter it has; default: the outer"),
        field<&ResonanceAngle::about>("about", "1", "name of the body that they orbit; default: the first"),
        field<&ResonanceAngle::G>("G", "length^3/mass/time^2", "default: the unit system's own"),
        state<&ResonanceAngle::samples_>("samples"), state<&ResonanceAngle::followed_>("followed"),
        state<&ResonanceAngle::low_>("low"), state<&ResonanceAngle::high_>("high"),
        state<&ResonanceAngle::first_>("first"));
  }

  /// @throws Error  for other than two bodies, p and q that are no resonance, a G that is not above 0
  void check() const;
  /// @throws Error  for a name that nobody has, and a primary that is one of the two or has no mass
  template <class Real> void check(const ParticleSystem<Real>& s) const;
  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;

  /// At the last look, from -pi to pi [rad]; NaN where an orbit is not bound.
  double value() const;
  /// Of all that was seen: the middle from -pi to pi, and half of the range [rad].
  double center() const;
  double amplitude() const { return samples_ > 0 ? (high_ - low_) / 2 : 0; }
  /// Whether it has stayed within less than a turn.
  bool librates() const;

 private:
  struct Places {
    Index inner, outer, pericenter, primary;
  };
  template <class Real> Places places_in(const ParticleSystem<Real>& s) const;

  std::int64_t samples_ = 0;
  double followed_ = std::numeric_limits<double>::quiet_NaN();  ///< not brought back into a turn
  double low_ = 0, high_ = 0, first_ = 0;
};

namespace detail {  // compiled once, in resonance_angle.cpp

extern template struct MonitorModel<ResonanceAngle, double>;
extern template struct MonitorModel<ResonanceAngle, Quad>;

}  // namespace detail

}  // namespace noether

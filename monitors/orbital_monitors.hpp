#pragma once
/// The monitors of orbits: osculating elements, closest approach.

#include "engine/monitor.hpp"
#include "engine/orbital_elements.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// Watches the osculating elements a, e, inc, Omega, omega, M of every particle relative to one, the primary.
///
/// mu = G (m_0 + m_i), m_0 of the primary, whose own row is NaN. Angles are in radians.
/// @cost O(n)
/// @source MurrayDermott1999
class Elements {
 public:
  std::optional<double> G = {};  ///< [length^3/mass/time^2]; default: the unit system's own
  std::string about = {};        ///< name of the primary; default: the first particle

  Elements() = default;
  explicit Elements(double constant) : G(constant) {}

  static constexpr bool needs_particles = true;

  static constexpr auto describe() {
    return part<Elements>(
        "elements", "osculating elements a, e, inc, Omega, omega, M about a body",
        formula("x, v relative to the body;  mu = G (m_0 + m_i), m_0 of the body"),
        quantities("value[n][6], columns a, e, inc, Omega, omega, M"), source("MurrayDermott1999"),
        field<&Elements::G>("G", "length^3/mass/time^2", "default: the unit system's own"),
        field<&Elements::about>("about", "1", "name of the body that the elements are about; default: the first"),
        state<&Elements::samples_>("samples"), state<&Elements::primary_>("primary"),
        state<&Elements::heaviest_>("heaviest"));
  }

  /// @throws Error  for a G that is not above 0
  void check() const { check_constant_of_gravitation(G); }
  /// @throws Error  for a primary that is not there, or has no mass
  template <class Real> void check(const ParticleSystem<Real>& s) const {
    check();
    const Index primary = primary_of(s);
    if (s.size() > 0 && !(s.masses()[primary] > Real(0))) refuse_massless(s.name(primary));
  }

  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;

  /// @throws Error  if parts of the saved state are missing
  void load(const SavedState& saved, const std::string& prefix);

  /// Elements of particle `i` at the last look.
  /// @throws std::out_of_range  if there is no such particle, or nothing was looked at yet
  OrbitalElements<double> of(Index i) const;

 private:
  /// @throws Error  if nobody has the name
  template <class Real> Index primary_of(const ParticleSystem<Real>& s) const;
  [[noreturn]] static void refuse_massless(const std::string& name);

  std::vector<double> rows_;  ///< shape (n, 6)
  std::int64_t samples_ = 0;
  std::string primary_, heaviest_;  ///< names at the last look; the second is empty where they are one
};

/// Watches for the smallest distance of two particles, one of them massive, since the start.
///
/// Between two looks the motion is the quintic Hermite polynomial of the two settled states, so an approach is found
/// even if it was over at the second look. Where the looks are too far apart for that (`Hermite::nearest`), the
/// pericenter of the pair tells (engine/kepler_passage.hpp), else only the distances at the looks count, and the report
/// says how often something may have been missed. The end of a run that is no look is looked at as well, and forgotten
/// where the run goes on.
/// @cost O(n m) with m massive bodies, and one force evaluation
class ClosestApproach {
 public:
  static constexpr bool needs_particles = true;

  static constexpr auto describe() {
    return part<ClosestApproach>(
        "closest_approach", "smallest distance of two particles so far, and its time",
        formula("min |x_i - x_j| along quintic Hermite paths between two samples"),
        quantities("distance [length], pair[2] (ids), at_time [time]"), state<&ClosestApproach::distance_>("distance"),
        state<&ClosestApproach::at_time_>("at_time"), state<&ClosestApproach::first_>("first"),
        state<&ClosestApproach::pair_>("pair"), state<&ClosestApproach::names_>("names"),
        state<&ClosestApproach::samples_>("samples"), state<&ClosestApproach::seen_time_>("seen_time"),
        state<&ClosestApproach::seen_ids_>("seen_ids"), state<&ClosestApproach::seen_>("seen"),
        state<&ClosestApproach::unresolved_>("unresolved"), state<&ClosestApproach::tracers_>("tracers"));
  }

  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;

  /// @throws Error if parts of the saved state do not fit
  void load(const SavedState& saved, const std::string& prefix);

  /// Looks at the end of a run, which no look of its own falls on.
  template <class Real> void at_end(const Snapshot<Real>& end);

  /// Smallest distance so far [length]; infinite where there is no pair.
  double distance() const { return latest().distance_; }
  /// When it was [time].
  double at_time() const { return latest().at_time_; }
  /// Ids of the two particles; empty where there is no pair.
  const std::vector<std::int64_t>& pair() const { return latest().pair_; }
  /// How often a pair may have been nearer between two looks that were too far apart to tell.
  std::int64_t unresolved() const { return latest().unresolved_; }

 private:
  template <class Real> void look_at_pairs(const Snapshot<Real>& now);
  template <class Real> void remember(const Snapshot<Real>& now);
  const ClosestApproach& latest() const { return at_end_ ? *at_end_ : *this; }

  double distance_ = std::numeric_limits<double>::infinity(), at_time_ = 0, first_ = 0;
  std::vector<std::int64_t> pair_;
  std::vector<std::string> names_;
  std::int64_t samples_ = 0, unresolved_ = 0, tracers_ = 0;
  std::shared_ptr<const ClosestApproach> at_end_;  ///< what has been seen with the end of the run, until the next look
  double seen_time_ = 0;                           ///< of the last look
  std::vector<std::int64_t> seen_ids_;             ///< of the particles it saw
  std::vector<Quad> seen_;                         ///< x, v, a of each, shape (n, 9)
};

namespace detail {  // compiled once, in orbital_monitors.cpp

extern template struct MonitorModel<Elements, double>;
extern template struct MonitorModel<Elements, Quad>;
extern template struct MonitorModel<ClosestApproach, double>;
extern template struct MonitorModel<ClosestApproach, Quad>;

}  // namespace detail

}  // namespace noether

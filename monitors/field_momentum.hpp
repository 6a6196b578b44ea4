#pragma once
/// The monitor of momentum that particles share with their field.

#include "engine/momentum_shares.hpp"
#include "engine/monitor.hpp"
#include "engine/statistics.hpp"

#include <concepts>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// Watches the momentum and the angular momentum of the particles of a system, and of the field between them.
///
/// Where action is not reaction at once, as between charges that move, neither stays for the particles alone.
/// `worst()` is the largest change of what both have together since the start, `worst_of_particles()` that of what
/// the particles have; momenta are measured by sum |p|, angular ones by sum |x||p| of the particles at the start,
/// and the larger of the two counts.
/// @cost O(n^2)
/// @source Jackson1999
class FieldMomentum {
 public:
  FieldMomentum() = default;
  /// Of a system that has `momentum_sharing()`.
  template <class S>
    requires requires(const S& system) { system.momentum_sharing(); }
  explicit FieldMomentum(const S& system) : sharing_(system.momentum_sharing()) {}

  static constexpr auto describe() {
    return part<FieldMomentum>(
        "field_momentum", "the momentum that the charges of a system have, and that of the field between them",
        formula("P = sum p_particle + P_field, L = sum x x p_particle + L_field"),
        quantities("particles[3], field[3] [mass length/time], particles_about[3], field_about[3] "
                   "[mass length^2/time], relative_error [1]"),
        source("Jackson1999"), state<&FieldMomentum::start_>("start"), state<&FieldMomentum::last_>("last"),
        state<&FieldMomentum::of_particles_>("of_particles"), state<&FieldMomentum::errors_>("errors"),
        state<&FieldMomentum::time_unit_>("time_unit"));
  }

  /// What there is to watch; scenes take it from their system.
  void watch(MomentumSharing sharing) { sharing_ = std::move(sharing); }
  /// @throws Error  for a run whose field has no momentum that is known
  template <class Real> void check(const ParticleSystem<Real>& /*s*/) const { require_sharing(); }
  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;

  double worst() const { return errors_.worst(); }
  double worst_of_particles() const { return of_particles_.worst(); }
  /// At the last look; nothing before the first.
  MomentumShares last() const;

 private:
  void require_sharing() const;

  MomentumSharing sharing_;
  std::vector<double> start_, last_;  ///< four vectors and two sizes
  SeriesStatistics of_particles_, errors_;
  std::string time_unit_;
};

namespace detail {  // compiled once, in field_momentum.cpp

extern template struct MonitorModel<FieldMomentum, double>;
extern template struct MonitorModel<FieldMomentum, Quad>;

}  // namespace detail

}  // namespace noether

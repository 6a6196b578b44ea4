#pragma once
/// The monitors of all rigid bodies together: how true their orientations are, and the energy of their turns.

#include "engine/monitor.hpp"
#include "engine/statistics.hpp"

#include <string>
#include <vector>

namespace noether {

/// Watches how far the orientations of bodies have come from unit quaternions: the largest | |q|^2 - 1 |.
/// @cost O(n), no force evaluation
class OrientationDefect {
 public:
  static constexpr bool needs_particles = true;

  static constexpr auto describe() {
    return part<OrientationDefect>(
        "orientation_defect", "how far orientations of rigid bodies have come from unit quaternions",
        formula("max_i | |q_i|^2 - 1 |"), quantities("value [1]"), state<&OrientationDefect::now_>("now"),
        state<&OrientationDefect::values_>("values"));
  }
  /// @throws Error  for particles without bodies among them
  template <class Real> void check(const ParticleSystem<Real>& s) const;
  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const { return {{"value", "1", {}, {now_}}}; }
  MonitorReport report() const;
  double value() const { return now_; }
  double worst() const { return values_.worst(); }

 private:
  double now_ = 0;
  SeriesStatistics values_;
};

/// Watches the kinetic energy of turns, and that of all centres beside it.
/// @cost O(n), no force evaluation
class TurningEnergy {
 public:
  static constexpr bool needs_particles = true;

  static constexpr auto describe() {
    return part<TurningEnergy>(
        "turning_energy", "kinetic energies of turns and of centres apart",
        formula("sum_i sum_k Pi_ik^2/2 I_ik,  sum_i m_i v_i^2/2"), quantities("value [energy], of_centers [energy]"),
        state<&TurningEnergy::now_>("now"), state<&TurningEnergy::of_centers_>("of_centers"),
        state<&TurningEnergy::values_>("values"), state<&TurningEnergy::slope_unit_>("slope_unit"));
  }
  /// @throws Error  for particles without bodies among them
  template <class Real> void check(const ParticleSystem<Real>& s) const;
  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const {
    return {{"value", "energy", {}, {now_}}, {"of_centers", "energy", {}, {of_centers_}}};
  }
  MonitorReport report() const;
  double value() const { return now_; }
  double of_centers() const { return of_centers_; }

 private:
  double now_ = 0, of_centers_ = 0;
  SeriesStatistics values_;
  std::string slope_unit_;
};

namespace detail {  // compiled once, in turning.cpp

extern template struct MonitorModel<OrientationDefect, double>;
extern template struct MonitorModel<OrientationDefect, Quad>;
extern template struct MonitorModel<TurningEnergy, double>;
extern template struct MonitorModel<TurningEnergy, Quad>;

}  // namespace detail

}  // namespace noether

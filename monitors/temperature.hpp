#pragma once
/// The monitor of temperature.

#include "engine/monitor.hpp"
#include "engine/statistics.hpp"

#include <string>
#include <vector>

namespace noether {

/// Watches the kinetic temperature
///
///     k_B T = 2 K / f,   f = 3 N + turns - constraints
///
/// of the N particles with mass. A rigid body has 3 turns, in a line 2; one that a fixed point holds has no more than
/// these. Where the run keeps momentum, the motion of the centre of mass is no heat: K is that
/// of velocities relative to it, and f is 3 less.
/// @cost O(n), no force evaluation
class Temperature {
 public:
  static constexpr bool needs_particles = true;

  static constexpr auto describe() {
    return part<Temperature>("temperature", "kinetic temperature of the degrees of freedom that are left",
                             formula("k_B T = 2 K / f,  f = 3 N + turns - constraints; where momentum is kept, K about "
                                     "the centre of mass and f - 3"),
                             quantities("value [temperature]"), source("Allen2017"), state<&Temperature::now_>("now"),
                             state<&Temperature::freedom_>("freedom"), state<&Temperature::values_>("values"),
                             state<&Temperature::slope_unit_>("slope_unit"));
  }

  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const { return {{"value", "temperature", {}, {now_}}}; }
  MonitorReport report() const;
  /// At the last look [temperature]; NaN without any degree of freedom.
  double value() const { return now_; }
  std::int64_t degrees_of_freedom() const { return freedom_; }

 private:
  double now_ = 0;
  std::int64_t freedom_ = 0;
  SeriesStatistics values_;
  std::string slope_unit_;
};

}  // namespace noether

#pragma once
/// The monitor of a first-order system: its variables.

#include "engine/monitor.hpp"
#include "engine/statistics.hpp"

#include <string>
#include <vector>

namespace noether {

/// Watches the variables of a first-order system: all of them in files, the figures of one in reports.
///
/// `worst()` is its largest magnitude, `slope()` its drift per time.
/// @cost O(n)
class Variables {
 public:
  std::string variable;  ///< whose figures the report shows: a name, or "y[3]"; empty: the first one

  Variables() = default;
  explicit Variables(std::string name) : variable(std::move(name)) {}

  static constexpr auto describe() {
    return part<Variables>(
        "variables", "the variables of a first-order system, and the figures of one of them", formula("value_i = y_i"),
        quantities("value[n]"), source("HairerNoersettWanner1993"),
        field<&Variables::variable>("variable", "1", "variable whose figures are reported; default: the first"),
        state<&Variables::figures_>("figures"), state<&Variables::slope_unit_>("slope_unit"),
        state<&Variables::shown_>("shown"));
  }

  /// @throws Error  for a run of particles, and for a name that no variable has
  template <class Real> void check(const ParticleSystem<Real>& s) const { static_cast<void>(place_in(s)); }
  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;

  double worst() const { return figures_.worst(); }
  double last() const { return figures_.last(); }

 private:
  template <class Real> std::size_t place_in(const ParticleSystem<Real>& s) const;

  Index place_ = -1;  ///< of the variable; found anew when a run goes on
  std::vector<double> values_;
  std::vector<std::string> names_;
  SeriesStatistics figures_;
  std::string slope_unit_, shown_;
};

namespace detail {  // compiled once, in variables.cpp

extern template struct MonitorModel<Variables, double>;
extern template struct MonitorModel<Variables, Quad>;

}  // namespace detail

}  // namespace noether

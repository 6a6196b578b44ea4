#pragma once
/// The monitor of how well constraints are kept.

#include "constraints/constraint_set.hpp"
#include "engine/monitor.hpp"
#include "engine/statistics.hpp"

namespace noether {

/// Watches the constraint that is violated most: max of ||r| - d| / d for lengths, |g| / scale for others.
/// @cost O(constraints), no force evaluation
class ConstraintResidual {
 public:
  explicit ConstraintResidual(ConstraintSet set = ConstraintSet()) : set_(std::move(set)) {}

  static constexpr bool needs_particles = true;

  static constexpr auto describe() {
    return part<ConstraintResidual>(
        "constraint_residual", "the largest violation of a constraint, and which constraint it is",
        formula("max over constraints of ||r| - d| / d, or |g| / scale"), quantities("worst [1], index [1]"),
        source("RyckaertCiccottiBerendsen1977"), state<&ConstraintResidual::now_>("now"),
        state<&ConstraintResidual::index_>("index"), state<&ConstraintResidual::residuals_>("residuals"));
  }

  /// The constraints to watch: a scene tells its own. @throws BadConstraints  if there are none
  void watch(const ConstraintSet& set);
  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;
  /// Largest relative violation so far [1].
  double worst() const { return residuals_.worst(); }

 private:
  ConstraintSet set_;
  double now_ = 0;
  std::int64_t index_ = -1;  ///< of the equation violated most at the last look
  SeriesStatistics residuals_;
};

}  // namespace noether

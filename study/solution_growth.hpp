#pragma once
/// Whether a solution itself leaves all bounds, so that no method is to blame.

#include "study/stability_trial.hpp"

#include <optional>

namespace noether {

/// How far the solution of a scene grows, by `dop853` with rtol = 1e-12, asked only where a run was found unbounded.
class SolutionGrowth {
 public:
  SolutionGrowth(const Scene& scene, double frequency) : scene_(scene), frequency_(frequency) {}

  /// Looks whether the solution explains a run that was not bounded, and lets the bounds know: they end where the
  /// solution is a tenth of `most` times as large as at the start, and growth on a linear problem counts no more where
  /// the solution grows half as much.
  /// @param time  how far the run went [time]
  /// @param budget  seconds of wall time
  /// @return whether the bounds have changed, so that the run is to be judged again
  bool explains(const Trial& run, double time, double budget, Bounds& bounds);

  /// When the solution is a tenth of `Bounds::most` times as large as at the start [time]; none where it is not, as far
  /// as is known.
  const std::optional<double>& leaves() const { return leaves_; }

 private:
  void look(double time, double budget, const Bounds& bounds);

  const Scene& scene_;
  double frequency_;
  double known_ = 0;    ///< the solution was followed up to here [time]
  double largest_ = 1;  ///< amplitude over that of the start, up to there
  std::optional<double> leaves_;
};

}  // namespace noether

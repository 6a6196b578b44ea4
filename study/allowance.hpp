#pragma once
/// What a comparison may cost: measuring must not take more work than the run that it is about.

#include "study/candidate.hpp"
#include "study/sampling.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace noether {

/// Evaluations of forces that a comparison may take in all, and has taken: those of its rows, of its reference, and of
/// what is tried before.
struct Allowance {
  double own_run = std::numeric_limits<double>::infinity();  ///< of the scene's whole run; infinity: not known
  double most = std::numeric_limits<double>::infinity();
  double spent = 0;

  double left() const { return std::max(0.0, most - spent); }
};

/// As many as the scene's own run takes, and at least what takes a few seconds for so many particles:
///
///     4e9 / (n (n + 100))
///
/// No bound for systems without particles, whose evaluations are the least of their cost, and where the scene has no
/// end.
/// @cost a few steps of the scene; they are counted as spent
Allowance allowance_of(const Scene& scene, const Sampling& sampling);

/// Evaluations per step of methods; each is measured once, at the first step that is asked for.
class StepCosts {
 public:
  explicit StepCosts(const Scene& scene) : scene_(scene) {}

  /// As `evaluations_per_step`; implicit methods take about as many at other steps.
  double of(const Candidate& who, double step);
  /// Evaluations that measuring took since the last call.
  double take_spent() { return std::exchange(spent_, 0.0); }

 private:
  const Scene& scene_;
  std::map<std::string, double> known_;  ///< by label
  double spent_ = 0;
};

}  // namespace noether

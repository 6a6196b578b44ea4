#pragma once
/// Sums of rates that go into a step of eight systems side by side.

#include "integrators/lane_field.hpp"

#include <cstddef>
#include <vector>

namespace noether {

/// Weights of the rates of a sum, those that are there, in the order in which they are added.
class LaneTerms {
 public:
  /// Of stages, the first of them first. Weights of 0 are left out.
  static LaneTerms of_stages(const std::vector<Quad>& row);
  /// Of the newest rate, the one before, and so on: the oldest are added first, for their weights are the least.
  static LaneTerms of_past(const std::vector<double>& weights);

  /// out = y + h (v + sum_j w_j k_j), which may stand in the place of y. @param v  null: none
  /// @param count  of numbers, those of eight lanes
  void sum(const double* y, const double* v, double h, const std::vector<LaneNumbers>& k, std::size_t count,
           double* out);
  void sum(const LaneNumbers& y, double h, const std::vector<LaneNumbers>& k, LaneNumbers& out) {
    sum(y.data(), nullptr, h, k, y.size(), out.data());
  }

 private:
  void add(double weight, std::size_t which);

  std::vector<double> weights_;
  std::vector<std::size_t> which_;
  std::vector<const double*> rates_;  ///< where they are
};

/// dy = (v, a) at y = (q, v).
void lane_rate(LaneField& f, double t, const LaneNumbers& y, LaneNumbers& dy);

}  // namespace noether

#include "integrators/methods/lane_terms.hpp"

#include "integrators/methods/lane_sums_simd.hpp"

#include <algorithm>

namespace noether {

LaneTerms LaneTerms::of_stages(const std::vector<Quad>& row) {
  LaneTerms terms;
  for (std::size_t j = 0; j < row.size(); ++j) {
    if (row[j] != Quad(0)) terms.add(static_cast<double>(row[j]), j);
  }
  return terms;
}

LaneTerms LaneTerms::of_past(const std::vector<double>& weights) {
  LaneTerms terms;
  for (std::size_t j = weights.size(); j-- > 0;) terms.add(weights[j], j);
  return terms;
}

void LaneTerms::add(double weight, std::size_t which) {
  weights_.push_back(weight);
  which_.push_back(which);
  rates_.push_back(nullptr);
}

void LaneTerms::sum(const double* y, const double* v, double h, const std::vector<LaneNumbers>& k, std::size_t count,
                    double* out) {
  for (std::size_t j = 0; j < which_.size(); ++j) rates_[j] = k[which_[j]].data();
  lane_sums_kernels().sum({.n = static_cast<std::ptrdiff_t>(count / LaneField::lanes),
                           .y = y,
                           .v = v,
                           .h = h,
                           .c = 1,
                           .g = 1,
                           .terms = std::ssize(weights_),
                           .k = rates_.data(),
                           .w = weights_.data(),
                           .out = out});
}

void lane_rate(LaneField& f, double t, const LaneNumbers& y, LaneNumbers& dy) {
  const auto half = static_cast<std::ptrdiff_t>(y.size() / 2);
  std::copy(y.begin() + half, y.end(), dy.begin());
  f.accelerations(t, y.data(), y.data() + half, dy.data() + half);
}

}  // namespace noether

#pragma once
/// Whether numbers are normal deviates.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace noether::test {

/// Chi square of numbers in 64 bins that are equally likely under a normal distribution of mean 0.
class NormalBins {
 public:
  explicit NormalBins(double variance = 1) : deviation_(std::sqrt(variance)) {}

  void add(double x) {
    const double probability = std::erfc(-x / deviation_ / std::sqrt(2.0)) / 2;
    ++counts_[static_cast<std::size_t>(std::min(63.0, 64 * probability))];
    ++total_;
  }
  double chi_square() const {
    const double expected = static_cast<double>(total_) / 64;
    double sum = 0;
    for (const long count : counts_) sum += std::pow(static_cast<double>(count) - expected, 2) / expected;
    return sum;
  }

 private:
  double deviation_;
  std::array<long, 64> counts_{};
  long total_ = 0;
};

}  // namespace noether::test

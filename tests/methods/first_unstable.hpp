#pragma once
/// Where a method begins to grow.

#include <functional>

namespace noether::test {

/// The first z from which on, upward in steps of 5e-4 and then by halving, the growth a step is above `threshold`.
inline double first_unstable(const std::function<double(double)>& growth, double threshold, double most) {
  const double step = 5e-4;
  for (double z = step; z < most; z += step) {
    if (!(growth(z) > threshold)) continue;
    double stable = z - step, unstable = z;
    for (int n = 0; n < 40; ++n) {
      const double middle = (stable + unstable) / 2;
      (middle > 0 && growth(middle) > threshold ? unstable : stable) = middle;
    }
    return unstable;
  }
  return most;
}

}  // namespace noether::test

#pragma once
/// Steps relative to a body that others pass closely: there doubles tell distances that they cannot tell at the origin.

#include "integrators/vector_field.hpp"
#include "numbers/double_double.hpp"

#include <array>
#include <cmath>

namespace noether {

/// An origin that stands in a body at the beginning of a step and goes on evenly.
///
/// Positions and velocities of particles are kept in two words each, and their differences are as right as both. But a
/// stage of a step is one word, known to eps |x|: near a body at x = 1 distances of 1e-9 keep seven digits. So a step
/// is made in the frame of that body: `enter` takes its state away, and `leave` adds it where the body would be by
/// then. Forces that depend on differences of positions alone do not see it.
class MovingOrigin {
 public:
  bool in_use() const { return in_use_; }
  /// Whether a step from y is to be made in the frame of a body, which is kept for `enter`.
  bool is_worth_it(const ParticleScales& scales, const Vector<double>& y) {
    const Index n = scales.particles();
    double worst = least;
    bool found = false;
    for (Index i = 0; i < n; ++i) {
      const double length = scales.length[static_cast<std::size_t>(i)];
      const double lost = length > 0 ? std::hypot(y[i], y[n + i], y[2 * n + i]) / length : 0;
      if (!(lost > worst)) continue;
      worst = lost;
      body_ = scales.neighbor[static_cast<std::size_t>(i)];
      found = true;
    }
    return found;
  }
  /// Leaves y + low relative to the body. @param low  second words of y
  void enter(Vector<double>& y, double* low) {
    const Index n = y.size() / 6;
    for (Index k = 0; k < 6; ++k) origin_[static_cast<std::size_t>(k)] = {y[k * n + body_], low[k * n + body_]};
    for (Index i = 0; i < y.size(); ++i) {
      put(DoubleDouble(y[i], low[i]) - origin_[static_cast<std::size_t>(i / n)], y[i], low[i]);
    }
    in_use_ = true;
  }
  /// And back, after a step of h.
  void leave(double h, Vector<double>& y, double* low) {
    const Index n = y.size() / 6;
    for (std::size_t k = 0; k < 3; ++k) origin_[k] += h * origin_[k + 3];
    for (Index i = 0; i < y.size(); ++i) {
      put(DoubleDouble(y[i], low[i]) + origin_[static_cast<std::size_t>(i / n)], y[i], low[i]);
    }
    in_use_ = false;
  }

 private:
  /// Where distances to a neighbor are so many times smaller than those to the origin, they have lost three digits.
  static constexpr double least = 1024;

  static void put(const DoubleDouble& both, double& high, double& low) {
    high = both.high;
    low = both.low;
  }

  Index body_ = 0;
  std::array<DoubleDouble, 6> origin_{};  ///< its x and v
  bool in_use_ = false;
};

}  // namespace noether

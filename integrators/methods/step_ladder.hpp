#pragma once
/// Lengths of steps on a ladder: they stay the same to the last bit where nothing changes.

#include <bit>
#include <cmath>
#include <cstdint>

namespace noether {

/// Steps of 2^k units times one of eight numbers from 1 to 1.83203125, each some 1.09 times the one before.
///
/// A method that keeps one step for long stays symplectic for as long, its errors do not add up, and what it predicts
/// by depends on few ratios of lengths. The unit comes from the first step of a run, so that a scene takes the same
/// steps in all units. It has 24 bits and a rung at most 9, so that a step has many fewer than 53: times are exact for
/// long.
class StepLadder {
 public:
  StepLadder() = default;
  /// @param step  a normal number above 0 [time]; the unit differs from it by a part of 2^-25 at most
  static StepLadder around(double step) {
    int exponent = 0;
    const double part = std::frexp(step, &exponent);
    return StepLadder(std::ldexp(std::round(std::ldexp(part, 24)), exponent - 24));
  }
  explicit StepLadder(double unit) : unit_(unit) {}

  double unit() const { return unit_; }

  /// The longest step that is not longer than h > 0.
  double below(double h) const {
    constexpr double rungs[] = {1, 1.08984375, 1.1875, 1.296875, 1.4140625, 1.5390625, 1.6796875, 1.83203125};
    int exponent = 0;
    const double part = 2 * std::frexp(h / unit_, &exponent);
    int k = 7;
    while (k > 0 && rungs[k] > part) --k;
    return std::ldexp(rungs[k], exponent - 1) * unit_;
  }

 private:
  double unit_ = 1;  ///< [time]
};

/// x^(1/n) to a part in a thousand, which is all that the length of a step asks for, for normal x > 0: a straight line
/// through the exponents, then a step of Halley's. It takes a third of the time of a power, and has the same bits
/// whatever library that comes from.
inline double near_root(double x, int n) {
  const auto one = std::bit_cast<std::int64_t>(1.0);
  const auto y = std::bit_cast<double>((std::bit_cast<std::int64_t>(x) - one) / n + one);
  double power = 1;
  for (int k = 0; k < n; ++k) power *= y;
  return y * ((n - 1) * power + (n + 1) * x) / ((n + 1) * power + (n - 1) * x);
}

}  // namespace noether

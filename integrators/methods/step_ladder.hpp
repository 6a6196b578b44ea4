#pragma once
/// Lengths of steps on a ladder: they stay the same to the last bit where nothing changes.

#include <bit>
#include <cmath>
#include <cstdint>

namespace noether {

/// The longest step 2^k, 1.1875 2^k, 1.4140625 2^k or 1.6796875 2^k that is not longer than h > 0.
///
/// A method that keeps one step for long stays symplectic for as long, its errors do not add up, and what it predicts
/// from several steps of one length holds. The few bits of such a step also leave times and squares exact.
inline double rung_below(double h) {
  constexpr double rungs[] = {1, 1.1875, 1.4140625, 1.6796875};
  int exponent = 0;
  const double part = 2 * std::frexp(h, &exponent);
  int k = 3;
  while (k > 0 && rungs[k] > part) --k;
  return std::ldexp(rungs[k], exponent - 1);
}

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

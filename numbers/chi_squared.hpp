#pragma once
/// Sums of squares of normal deviates, drawn at once.

#include "numbers/random.hpp"

#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>

namespace noether {

/// The sum of the squares of so many independent normal deviates, without drawing them: twice a deviate of the gamma
/// distribution of shape degrees / 2.
///
///     d = degrees/2 - 1/3,  v = (1 + x / sqrt(9 d))^3,  x normal, u uniform;  2 d v if ln u < x^2/2 + d (1 - v + ln v)
///
/// By sums, products, quotients and roots only, as `normal_pair`: the same bits everywhere.
/// @param degrees  0 or more
/// @param bits  `bits(k)`: the k-th 128 random bits of this draw, from 0 on
/// @throws never
/// @cost of 2 degrees and more about two calls of `bits`, a few more in one draw of twenty
/// @source MarsagliaTsang2000
template <std::invocable<std::uint32_t> Bits> double chi_squared(std::int64_t degrees, const Bits& bits) {
  if (degrees == 0) return 0;
  if (degrees == 1) {
    const double x = normal_pair(bits(0))[0];
    return x * x;
  }
  const double d = static_cast<double>(degrees) / 2 - 1.0 / 3, width = 1 / std::sqrt(9 * d);
  for (std::uint32_t attempt = 0;; attempt += 2) {
    const double x = normal_pair(bits(attempt))[0], root = 1 + width * x;
    if (!(root > 0)) continue;
    const std::array<std::uint32_t, 4> more = bits(attempt + 1);
    const double v = root * root * root, u = open_uniform(more[0], more[1]);
    if (detail::log_by_series(u) < x * x / 2 + d * (1 - v + detail::log_by_series(v))) return 2 * d * v;
  }
}

}  // namespace noether

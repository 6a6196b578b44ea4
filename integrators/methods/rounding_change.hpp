#pragma once
/// When a change of the rates of a step is rounding.

#include "integrators/vector_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace noether {

/// What the rates of a step are those of.
enum class RatesOf : std::uint8_t {
  one_kind,   ///< all of y, of one unit
  two_kinds,  ///< all of y, whose halves have units of their own
  velocities  ///< the second half of y, and the first half follows from it
};

/// Whether a change of all rates would change y by rounding alone in a step of h, relative to its largest values: where
/// forces nearly vanish, their rounding is that of the positions they come from, and at turning points velocities have
/// no size either.
template <class Real> bool is_rounding(const Vector<Real>& y, RatesOf rates, double h, double change) {
  const Index n = y.size();
  const auto largest = [&](Index begin, Index end) {
    double most = 0;
    for (Index i = begin; i < end; ++i) most = std::max(most, std::abs(static_cast<double>(y[i])));
    return most;
  };
  const double kick = std::abs(h) * change, little = std::is_same_v<Real, double> ? 1e-13 : 1e-29;
  if (rates == RatesOf::one_kind) return kick < little * largest(0, n);
  const double first = largest(0, n / 2), second = largest(n / 2, n);
  if (rates == RatesOf::two_kinds) return kick < little * std::min(first, second);
  const double moved = std::abs(h) * kick;
  constexpr double ulps = std::is_same_v<Real, double> ? 0x1p-48 : 0x1p-108;
  return moved < ulps * first || (moved < little * first && kick < little * second);
}

}  // namespace noether

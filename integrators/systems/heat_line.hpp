#pragma once
/// The heat equation on a line, by the method of lines.

#include "engine/description.hpp"
#include "integrators/vector_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace noether {

/// u_t = D u_xx between two ends of given temperature, at n interior points a distance d = length / (n + 1) apart.
///
///     u_i' = D (u_(i-1) - 2 u_i + u_(i+1)) / d^2
///
/// It begins with a straight line between the ends and one sine on it, sin(k pi x / length), which decays at the rate
/// 4 D / d^2 sin^2(k pi / (2 (n + 1))) of the equations as they stand. The fastest rate is nearly 4 D / d^2: what an
/// explicit method costs grows with the square of n.
/// @source HairerWanner1996
struct HeatLine {
  std::int64_t points = 50;  ///< n
  double length = 1;         ///< [length]
  double diffusivity = 1;    ///< D [length^2/time]
  double left = 0;           ///< temperature at x = 0 [1]
  double right = 0;          ///< temperature at x = length [1]
  std::int64_t mode = 1;     ///< k of the sine at the start

  static constexpr auto describe() {
    return part<HeatLine>("heat_line", "the heat equation on a line, by the method of lines",
                          formula("u_i' = D (u_(i-1) - 2 u_i + u_(i+1)) / d^2,  d = length / (points + 1)"),
                          source("HairerWanner1996"), quantities("u[points] [1]"),
                          field<&HeatLine::points>("points", "1", "number of points between the ends"),
                          field<&HeatLine::length>("length", "length", "length of the line"),
                          field<&HeatLine::diffusivity>("diffusivity", "length^2/time", "D"),
                          field<&HeatLine::left>("left", "1", "temperature of the left end"),
                          field<&HeatLine::right>("right", "1", "temperature of the right end"),
                          field<&HeatLine::mode>("mode", "1", "half waves of the sine at the start"));
  }
  /// @throws Error  for what is no line
  void check() const {
    if (points > most) {
      refuse_field("points", static_cast<double>(points), fmt::format("is too many; at most {} are expected", most));
    }
    if (points < 1) refuse_field("points", static_cast<double>(points), "is too few; 1 or more is expected");
    if (!(length > 0)) refuse_field("length", length, "is not a valid length of a line; a length above 0 is expected");
    if (!(diffusivity >= 0)) refuse_field("diffusivity", diffusivity, "is negative; 0 or more is expected");
    if (mode < 1 || mode > points) {
      refuse_field("mode", static_cast<double>(mode),
                   "cannot be resolved by the points; 1 to the number of points is expected");
    }
  }

  static constexpr std::int64_t most = 1'000'000;  ///< of them, so that memory is not asked for in vain

  Index size() const { return static_cast<Index>(points); }
  std::vector<double> start() const { return exact(0); }
  /// The solution that begins at `start()`.
  std::vector<double> exact(double t) const {
    std::vector<double> u;
    const double decay = std::exp(-rate_of(mode) * t);
    for (std::int64_t i = 1; i <= points; ++i) {
      const double x = static_cast<double>(i) / static_cast<double>(points + 1);
      const double wave = std::sin(static_cast<double>(mode) * std::numbers::pi * x);
      u.push_back(left + (right - left) * x + decay * wave);
    }
    return u;
  }
  /// Rate at which sine `k` decays [1/time].
  double rate_of(std::int64_t k) const {
    const double n = static_cast<double>(points + 1);
    const double half = std::sin(static_cast<double>(k) * std::numbers::pi / (2 * n));
    return 4 * diffusivity * (n / length) * (n / length) * half * half;
  }
  Sparsity sparsity() const {
    Sparsity columns(static_cast<std::size_t>(points));
    for (Index j = 0; j < size(); ++j) {
      for (Index i = std::max<Index>(j - 1, 0); i <= std::min(j + 1, size() - 1); ++i) {
        columns[static_cast<std::size_t>(j)].push_back(i);
      }
    }
    return columns;
  }

  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const {
    const Real over = Real(static_cast<double>(points + 1)) / Real(length);
    const Real factor = Real(diffusivity) * over * over;
    const Index last = size() - 1;
    for (Index i = 0; i <= last; ++i) {
      const Real before = i == 0 ? Real(left) : y[i - 1], after = i == last ? Real(right) : y[i + 1];
      dy[i] = factor * (before - Real(2) * y[i] + after);
    }
  }
};

}  // namespace noether

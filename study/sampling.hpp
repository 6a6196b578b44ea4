#pragma once
/// When the runs of a comparison are looked at: the same moments for every one of them.

#include "numbers/error.hpp"
#include "numbers/real.hpp"
#include "numbers/types.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace noether {

/// States of larger systems are not kept: a comparison holds two hundred of them for every row.
inline constexpr Index most_bodies = 300;

/// `samples` moments at equal distances, the last one at the end; the start is moment 0. Times count from the start.
struct Sampling {
  double interval = 0;  ///< [time]
  int samples = 200;
  double start = 0;  ///< what the clock shows at moment 0 [time]

  double end() const { return interval * samples; }
  /// Moment `j` as adaptive methods are shown it [time].
  double time(int j) const { return interval * j; }
  /// The same, exact.
  Quad exact_time(int j) const { return Quad(interval) * Quad(j); }
  /// What the clock shows then, exact [time].
  Quad clock_time(int j) const { return Quad(start) + exact_time(j); }

  /// How many steps of about `step` make one interval; at least 1.
  /// @throws Error  for a step of which the whole run has more than can be counted
  std::int64_t steps_for(double step) const {
    constexpr double most = 9e15;  // a double counts no further
    if (!(end() / std::abs(step) <= most)) {
      throw Error(fmt::format("a run of {:.6g} has more steps of {} than can be counted; give steps of at least {:.2g}",
                              end(), step, 1.1 * end() / most));
    }
    return std::max<std::int64_t>(1, std::llround(interval / std::abs(step)));
  }
};

}  // namespace noether

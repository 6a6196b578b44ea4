#pragma once
/// The solution of an implicit step that continues the motion, followed from a step of no length.

#include <algorithm>

namespace noether {

/// How far a root could be followed, as a fraction of the step.
struct FollowedRoot {
  double reached = 0;
  bool lost = false;  ///< it ends there: the matrix of its equations has no inverse; else it was only too long a way
};

/// Follows a root over fractions of a step. `solve(to, from)` finds the one at fraction `to` near that of `from` (0:
/// the start) by a matrix from its guess alone, keeps it and returns true, or leaves what it has and returns false.
/// Fractions grow where that works, and shrink where it does not.
/// @cost some ten to two hundred solutions
template <class Solve> FollowedRoot follow_root(const Solve& solve) {
  constexpr double smallest = 0x1p-20;
  constexpr int most = 200;
  double reached = 0, ahead = 0.125;
  for (int tried = 0; tried < most; ++tried) {
    const double to = std::min(1.0, reached + ahead);
    if (solve(to, reached)) {
      if (to == 1) return {1, false};
      reached = to;
      ahead *= 2;
    } else {
      ahead /= 4;
      if (ahead < smallest) return {reached, true};
    }
  }
  return {reached, false};
}

}  // namespace noether

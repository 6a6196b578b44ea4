#pragma once
/// How often Newton's method takes velocities off the constraints.

#include <algorithm>
#include <cmath>

namespace noether {

/// Each time leaves a part of what it meets: what rounding makes of a factorisation, about 1e-15 times the largest
/// ratio of masses. Twice is enough for those of molecules.
/// @param ratio  of the largest mass of a molecule to its smallest
inline int velocity_passes(double ratio) {
  if (!(ratio > 1e6)) return 2;
  const double digits = std::max(15.2 - std::log10(ratio), 1.5);
  return 1 + static_cast<int>(std::ceil(16 / digits));
}

}  // namespace noether

#pragma once
/// How often Newton's method projects velocities onto the constraints.

#include <algorithm>
#include <cmath>

namespace noether {

/// Each pass leaves a fraction of the error that it meets, about 1e-15 times the largest ratio of masses: the rounding
/// of a factorisation. Twice is enough for those of molecules.
/// @param ratio  of the largest mass of a molecule to its smallest
inline int velocity_passes(double ratio) {
  if (!(ratio > 1e6)) return 2;
  const double digits = std::max(15.2 - std::log10(ratio), 1.5);
  return 1 + static_cast<int>(std::ceil(16 / digits));
}

}  // namespace noether

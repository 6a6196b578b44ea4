#pragma once
/// What the sweeps of `WideGauss` in lanes work on.

#include <cstddef>

namespace noether {

/// Coefficients of the method, in two words: eight high ones, eight low ones.
struct alignas(64) WideGaussWeights {
  double c[2][8];
  double twice[8][2][8];  ///< of the rates of stage j in the place of each stage: (a a)_ij in lane i
};

/// Positions and velocities of n variables where a step begins, in two words.
struct WideGaussStart {
  std::ptrdiff_t n;
  const double *x, *x_low, *v, *v_low;
};

}  // namespace noether

#pragma once
/// Sweeps of `WideGauss`, its eight stages in lanes, in doubles and in two words: the interface of
/// `wide_gauss_simd.cpp`.

#include "integrators/methods/wide_gauss_row.hpp"
#include "numbers/kernels_simd.hpp"

namespace noether {

/// Rates and places have eight numbers for each variable, or eight high words and eight low ones.
struct WideGaussKernels {
  /// Where the stages are: x + c_i h v + h^2 sum_j (a a)_ij F_j.
  void (*place)(const WideGaussWeights& weights, const WideGaussStart& start, double h, const double* rates,
                double* places);
  void (*place_wide)(const WideGaussWeights& weights, const WideGaussStart& start, double h, const double* rates,
                     double* places);
  /// Accelerations by gravity of n bodies at all stages. @param gm, gm_low  G m of each body in two words
  void (*attract)(std::ptrdiff_t n, const double* gm, const double* gm_low, const double* places, double* rates);
  void (*attract_wide)(std::ptrdiff_t n, const double* gm, const double* gm_low, const double* places, double* rates);
};

NOETHER_KERNELS(WideGaussKernels, wide_gauss_kernels)

}  // namespace noether

#pragma once
/// The arithmetic of collocation in lanes of doubles: the interface of `collocation_simd.cpp`.

#include "numbers/kernels_simd.hpp"

#include <cstddef>
#include <cstdint>

namespace noether {

/// n variables at eight stages: `rates`, `out` of shape (n, 8); values and rounding errors of the variables of shape
/// (n).
struct StageSums {
  std::ptrdiff_t n;
  const double* rates;  ///< F
  const double *y, *low;
  double h, h2, h2_low;  ///< h^2, and what rounding takes from it: the same at every step, it would be a drift
  int terms = 8;         ///< that count, 4 or 8; the other rates are 0
};

/// What a step adds to n variables. `weights`, `weights_low`, `twice`, `twice_low`: shape (8).
struct StepSums {
  std::ptrdiff_t n;
  const double* rates;  ///< F, shape (n, 8), n rounded up to a multiple of eight
  const double *weights, *weights_low, *twice, *twice_low;
  double h, h2, h2_low;
  double *q, *q_low;  ///< variables of first order: null
  double *v, *v_low;  ///< velocities, or the variables of first order
};

struct CollocationKernels {
  /// out_i = y + (h sum_j a_ji F_j + low), a of shape (8, 8)
  void (*values)(const StageSums& sums, const double* a, double* out);
  /// out_i = y + (c_i h v + (c_low_i h v + h^2 sum_j a_ji F_j + low))
  void (*positions)(const StageSums& sums, const double* a, const double* c, const double* c_low, const double* v,
                    double* out);
  /// w of shape (8, 8): what the polynomial through the nodes c has at 1 + c_i ratio, from each node j, whose weight in
  /// Lagrange's formula is `barycentric`
  void (*extrapolation)(const double* c, const double* barycentric, double ratio, double* w);
  /// out_i = sum_j w_ji F_j
  void (*combine)(const StageSums& sums, const double* w, double* out);
  /// The stages, a bit each, where any of n variables is another than `known`, which becomes q.
  std::uint8_t (*moved)(std::ptrdiff_t n, const double* q, double* known);
  /// Rates of n variables become `fresh`; the largest change, and the largest |fresh|: not a number if one is none.
  void (*take)(std::ptrdiff_t n, const double* fresh, double* rates, double* change, double* size);
  /// into_i <- sum_j w_ji F_j for i < terms, and as `take` their largest change and size
  void (*take_combined)(const StageSums& sums, const double* w, double* into, double* change, double* size);
  /// sum_j w_j F_j and max_j |F_j| of each variable, shape (n), all shapes rounded up to a multiple of eight.
  void (*coefficient)(std::ptrdiff_t n, const double* rates, const double* w, double* sum, double* largest);
  /// q += h v + h^2 sum twice_j F_j, v += h sum weights_j F_j, with their rounding errors
  void (*finish)(const StepSums& sums);
};

NOETHER_KERNELS(CollocationKernels, collocation_kernels)

}  // namespace noether

#pragma once
/// Sums over the stages of a step of eight systems side by side: the interface of `lane_sums_simd.cpp`.

#include "numbers/kernels_simd.hpp"

#include <cstddef>
#include <cstdint>

namespace noether {

/// What n variables become by `terms` rates: y + h (c v + g sum_j w_j k_j). Lane k of number i is at [8 i + k], here
/// and below; `k` of shape (terms), each of shape (n, 8).
struct LaneSum {
  std::ptrdiff_t n;
  const double *y, *v;  ///< no v: null
  double h, c, g;
  std::ptrdiff_t terms;
  const double* const* k;
  const double* w;
  double* out;
};

/// The states of all stages of a step: y + (d_i v + (d_low_i v + sum_j w_ji F_j + low)).
struct LaneStages {
  std::ptrdiff_t n;
  int stages;                   ///< at most 8
  const double* rates;          ///< F, shape (stages, n, 8)
  const double *y, *low, *v;    ///< shape (n, 8)
  const double *d, *d_low, *w;  ///< shapes (8), (8), and (8, 8) by j
  double* out;                  ///< shape (stages, n, 8)
};

/// What a step adds to positions and velocities: h v + sum_j twice_j F_j and sum_j once_j F_j, with their rounding
/// errors, and second words of weights.
struct LaneEnd {
  std::ptrdiff_t n;
  int stages;
  const double* rates;
  double h;
  const double *once, *once_low, *twice, *twice_low;  ///< shape (8)
  double *q, *q_low, *v, *v_low;                      ///< shape (n, 8)
};

/// A new point that an implicit formula is put to by the rate there: known + weight fresh.
struct LaneCorrection {
  std::ptrdiff_t n;
  double h, weight;
  const double *y, *rate;   ///< the point before and the rate there, shape (n, 8)
  const double* known;      ///< all terms but that of the new rate, shape (n, 8)
  const double* fresh;      ///< the rate at the new point, shape (n, 8)
  const std::int64_t* on;   ///< lanes that are to be changed (all bits; else 0), shape (8)
  double *point, *of_rate;  ///< the new point, and the rate that it comes from, shape (n, 8)
};

struct LaneSumsKernels {
  void (*sum)(const LaneSum& sums);
  void (*stages)(const LaneStages& sums);
  /// Rates of n variables become `fresh` in lanes that are `on` (all bits; else 0), shape (8); in every lane the
  /// largest change, and the largest |fresh|, each of shape (8): not a number if one is none.
  void (*take)(std::ptrdiff_t n, const double* fresh, const std::int64_t* on, double* rates, double* change,
               double* size);
  void (*finish)(const LaneEnd& sums);
  /// value + low += x, for n numbers, a whole number of eights.
  void (*add)(std::ptrdiff_t n, const double* x, double* value, double* low);
  /// @param moved  by how much the new point is moved in a lane at most, in units of the size of a variable, which is
  ///   the largest of |y|, |point| and |h rate|: not a number if one is none; shape (8)
  void (*correct)(const LaneCorrection& by, double* moved);
};

NOETHER_KERNELS(LaneSumsKernels, lane_sums_kernels)

}  // namespace noether

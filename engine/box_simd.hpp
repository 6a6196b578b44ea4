#pragma once
/// Drifts and places in a periodic box in lanes: the interface of `box_simd.cpp`, compiled once per SIMD level.

#include "numbers/kernels_simd.hpp"

#include <cstddef>

namespace noether {

/// One axis of a box.
struct BoxAxis {
  double edge;
  double magic;    ///< 1.5 x 2^52 times the spacing of the grid: adding and subtracting it rounds to the grid
  double longest;  ///< what it rounds right
};

struct BoxKernels {
  /// x -> x + h v, rounded to the grid, for coordinates from `from` on, until it meets one that leaves [0, edge) or
  /// goes further than the longest step. Returns which one, or `count`.
  std::ptrdiff_t (*advance)(const BoxAxis& axis, double h, const double* v, double* x, std::ptrdiff_t from,
                            std::ptrdiff_t count);
  /// Rounds coordinates to the grid from `from` on, until it meets one that is outside of [0, edge). Returns which one,
  /// or `count`.
  std::ptrdiff_t (*round)(const BoxAxis& axis, double* x, std::ptrdiff_t from, std::ptrdiff_t count);
};

NOETHER_KERNELS(BoxKernels, box_kernels)

}  // namespace noether

#pragma once
/// Sums of products over particles to twice the digits of a double: the interface of `moments_simd.cpp`, compiled once
/// per SIMD level.

#include "engine/wide_sums_row.hpp"
#include "numbers/kernels_simd.hpp"

#include <cstddef>

namespace noether {

/// Vectors of many particles, one array per axis, and their masses.
struct WeightedVectors {
  std::ptrdiff_t count;
  const double* mass;
  const double* x[3];
};

/// Sums of exact products, right to count^2 2^-104 of the sum of all sizes. Terms are cut to grids that the largest of
/// them sets, and on which all additions are exact: sums have the same bits in any order of particles.
struct MomentKernels {
  /// Sum of m_i x_i.
  void (*weighted)(const WeightedVectors& vectors, WideSums& sums);
  /// Sum of x_i cross m_i v_i.
  void (*crossed)(const WeightedVectors& velocities, const double* const (&x)[3], WideSums& sums);
};

NOETHER_KERNELS(MomentKernels, moment_kernels)

}  // namespace noether

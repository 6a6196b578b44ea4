#pragma once
/// Whether numbers are finite, in lanes: the interface of `finite_simd.cpp`, compiled once per SIMD level.

#include "numbers/kernels_simd.hpp"

#include <cstddef>

namespace noether {

struct FiniteKernels {
  /// All numbers of two columns. @param count  of each, a multiple of 8
  bool (*all)(const double* a, const double* b, std::ptrdiff_t count);
};

NOETHER_KERNELS(FiniteKernels, finite_kernels)

}  // namespace noether

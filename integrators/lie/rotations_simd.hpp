#pragma once
/// Eight rotations side by side: the interface of `rotations_simd.cpp`, compiled once per SIMD level.

#include "numbers/kernels_simd.hpp"

#include <cstddef>

namespace noether {

struct RotationKernels {
  /// out_i = q_i exp(u_i), renormalized, for i in [from, to), with the bits that `rotation_by` leads to: quaternions q
  /// and out of shape (n, 4), angles u of shape (n, 3); eight at a time, until fewer are left or it meets eight one of
  /// which turns by more than a right angle, or not by a number. Returns where it has come to.
  std::ptrdiff_t (*turn)(const double* q, const double* u, double* out, std::ptrdiff_t from, std::ptrdiff_t to);
};

NOETHER_KERNELS(RotationKernels, rotation_kernels)

}  // namespace noether

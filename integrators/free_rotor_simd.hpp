#pragma once
/// Free turns of eight bodies side by side: the interface of `free_rotor_simd.cpp`, compiled once per SIMD level.

#include "numbers/kernels_simd.hpp"

#include <cstddef>

namespace noether {

/// The columns of bodies: component k of body i stands at `[k][i]`.
struct TurningColumns {
  double* orientation[4];
  const double* spin[3];
  const double* inertia[3];
  double* action;
};

struct FreeRotorKernels {
  /// Turns the bodies of [from, to) axis by axis, as `turn_by_axes` does and with its bits, eight at a time from a
  /// multiple of eight on, until it meets eight one of which turns by more than a right angle about one axis, or
  /// not by a number. Returns their first, or `to`.
  /// @param order  three axes: the first two for half a step each, the third for a whole one, and back
  std::ptrdiff_t (*by_axes)(const TurningColumns& bodies, double h, const int* order, std::ptrdiff_t from,
                            std::ptrdiff_t to);
};

NOETHER_KERNELS(FreeRotorKernels, free_rotor_kernels)

}  // namespace noether

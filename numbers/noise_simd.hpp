#pragma once
/// Noise of many particles in lanes: the interface of `noise_simd.cpp`, compiled once per SIMD level.

#include "numbers/kernels_simd.hpp"

#include <cstddef>
#include <cstdint>

namespace noether {

struct NoiseKernels {
  /// As `noise` of numbers/random.hpp, bit for bit, for so many ids, a multiple of `lanes`; null where there are no
  /// lanes.
  void (*normals)(const std::uint32_t (&key)[2], const std::int64_t* ids, std::ptrdiff_t count, std::int64_t step,
                  std::uint32_t stage, double* x, double* y, double* z);
  std::ptrdiff_t lanes;
};

NOETHER_KERNELS(NoiseKernels, noise_kernels)

}  // namespace noether

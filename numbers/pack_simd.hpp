#pragma once
/// Whole packs, moved by the widest registers: the interface of `pack_simd.cpp`.

#include "numbers/kernels_simd.hpp"

#include <cstddef>

namespace noether {

struct PackKernels {
  void (*copy)(const double* from, double* to, std::size_t packs);
  void (*clear)(double* to, std::size_t packs);
};

NOETHER_KERNELS(PackKernels, pack_kernels)

}  // namespace noether

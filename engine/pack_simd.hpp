#pragma once
/// Whole packs, moved by the widest registers: the interface of `pack_simd.cpp`.

#include "engine/simd.hpp"

#include <cstddef>

namespace noether {

struct PackKernels {
  void (*copy)(const double* from, double* to, std::size_t packs);
  void (*clear)(double* to, std::size_t packs);
};

namespace base {
extern const PackKernels pack_kernels;
}
#if NOETHER_SIMD_LEVELS
namespace avx2 {
extern const PackKernels pack_kernels;
}
namespace avx512 {
extern const PackKernels pack_kernels;
}
#endif

}  // namespace noether

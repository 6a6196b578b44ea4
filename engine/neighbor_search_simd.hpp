#pragma once
/// The search for neighbors in lanes: the interface of `neighbor_search_simd.cpp`, compiled once per SIMD level.

#include "engine/simd.hpp"

#include <cstddef>
#include <cstdint>

namespace noether {

/// Points near a place, in single precision relative to it, shape (count) each, and their numbers. Arrays have room
/// for 16 more, of which nothing is expected.
struct NearPoints {
  float *x, *y, *z;
  std::int32_t* number;
  std::ptrdiff_t count;
};

/// A box along the axes: its middle and half of its edges.
struct SearchBox {
  float middle[3], half[3];
};

struct NeighborSearchKernels {
  /// Appends those of `count` points x, y, z whose squared distance from a box is up to `limit`, relative to its
  /// middle; the first has the number `first`. 16 more can be read, and have room.
  void (*gather)(const float* x, const float* y, const float* z, std::ptrdiff_t count, std::int32_t first,
                 const SearchBox& box, float limit, NearPoints& points);
  /// Writes the numbers of all points but `self` whose squared distance from (x, y, z) is up to `limit`, in order, and
  /// returns how many there are; `out` has room for all and 16 more.
  std::ptrdiff_t (*select)(const NearPoints& points, float x, float y, float z, float limit, std::int32_t self,
                           std::int32_t* out);
  /// Turns eight lists into rows of eight, each number times four; lists have room up to the next multiple of eight
  /// rows, as has `out`.
  void (*turn)(const std::int32_t* const (&lists)[8], std::ptrdiff_t rows, std::int32_t* out);
};

namespace base {
extern const NeighborSearchKernels neighbor_search_kernels;
}
#if NOETHER_SIMD_LEVELS
namespace avx2 {
extern const NeighborSearchKernels neighbor_search_kernels;
}
namespace avx512 {
extern const NeighborSearchKernels neighbor_search_kernels;
}
#endif

/// The kernels of the level in use.
inline const NeighborSearchKernels& neighbor_search_kernels() {
#if NOETHER_SIMD_LEVELS
  return at_simd_level(base::neighbor_search_kernels, avx2::neighbor_search_kernels, avx512::neighbor_search_kernels);
#else
  return base::neighbor_search_kernels;
#endif
}

}  // namespace noether

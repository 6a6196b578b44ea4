#pragma once
/// Tetrahedra of the built-in materials, eight side by side: the interface of `tetrahedra_simd.cpp`, compiled once per
/// SIMD level.

#include "forces/tetrahedron_row.hpp"
#include "numbers/kernels_simd.hpp"

namespace noether {

struct TetrahedronKernels {
  /// Writes the forces of the groups [from, to) into their slots, with the bits that elements have one by one.
  /// @return whether det F > 0 in all of them; what stands in the slots is right only then
  bool (*forces)(const TetrahedronGroups& groups, std::ptrdiff_t from, std::ptrdiff_t to);
};

NOETHER_KERNELS(TetrahedronKernels, tetrahedron_kernels)

}  // namespace noether

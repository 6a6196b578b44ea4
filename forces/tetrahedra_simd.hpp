#pragma once
/// Tetrahedra of the built-in materials, eight side by side: the interface of `tetrahedra_simd.cpp`, compiled once per
/// SIMD level.

#include "numbers/kernels_simd.hpp"

#include <cstddef>
#include <cstdint>

namespace noether {

/// Groups of eight elements (forces/mesh_elements.hpp), where their particles are, and where their forces go.
struct TetrahedronGroups {
  const std::int32_t* corners;  ///< shape (groups, 4, 8)
  const double* shapes;         ///< shape (groups, 10, 8)
  const double* x[3];           ///< of the particles
  double* slots;                ///< shape (groups, 12, 8)
  double half_lambda, mu;
  bool neo_hookean;
};

struct TetrahedronKernels {
  /// Writes the forces of the groups [from, to) into their slots, with the bits that elements have one by one.
  /// @return whether det F > 0 in all of them; what stands in the slots is right only then
  bool (*forces)(const TetrahedronGroups& groups, std::ptrdiff_t from, std::ptrdiff_t to);
};

NOETHER_KERNELS(TetrahedronKernels, tetrahedron_kernels)

}  // namespace noether

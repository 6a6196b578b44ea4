#pragma once
/// Tetrahedra in groups of eight, as the kernels in lanes and the loops around them see them.

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

}  // namespace noether

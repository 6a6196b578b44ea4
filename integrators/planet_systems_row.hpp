#pragma once
/// Planets of eight systems side by side: what the kernels of `planet_systems_simd.cpp` work on.

#include "integrators/planet_row.hpp"

#include <cstddef>

namespace noether {

/// One planet of each of eight systems, in Jacobi coordinates.
struct alignas(64) SystemRow : ArcRow {
  double y[3][8];       ///< relative to the star, as the last kick met it
  double pull[3][8];    ///< accelerations of the last kick, inertial
  double attracts[8];   ///< G m_k
  double share[8];      ///< m_k/M_k, with M_k the mass of the star and the planets up to this one
  double of_star[8];    ///< m_k/m_0
  double beside[3][8];  ///< accelerations by other forces, where there are some
};

/// All planets of eight systems, the innermost first.
struct SystemRows {
  SystemRow* row;
  std::ptrdiff_t count;
  const double* star;        ///< G m_0, one for each system
  const double* relativity;  ///< 6 (G m_0/c)^2, one for each system; null without general relativity
  const double* beside;      ///< accelerations of the star by other forces, shape (3, 8); null without them
  double* center;            ///< what a kick adds to the velocities of the centres of mass, shape (3, 8)
  bool compensated;          ///< whether what rounding takes is kept
  ExactArc exact;
};

}  // namespace noether

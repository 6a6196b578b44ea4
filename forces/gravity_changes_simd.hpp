#pragma once
/// How direct gravity changes where bodies move a little, in eight systems at once: the interface of
/// `gravity_changes_simd.cpp`.

#include "numbers/kernels_simd.hpp"

#include <cstddef>

namespace noether {

/// Coordinates of n bodies in eight systems, their masses, small changes of the coordinates, and what these do to
/// accelerations, shape (n, 8) each.
struct ChangesOfBodies {
  const double *x, *y, *z, *m;
  const double *ux, *uy, *uz;
  double *ax, *ay, *az;  ///< sums so far
  std::ptrdiff_t count;
};

/// Adds (u . grad) a of every pair, each pair once; two bodies of no mass in the first system have none in the others.
using AttractChanges = void (*)(const ChangesOfBodies& bodies, double G, double softening2);

NOETHER_KERNELS(AttractChanges, attract_changes)

}  // namespace noether

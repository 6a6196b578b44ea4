#pragma once
/// Direct gravity of few bodies at eight stages at once: the interface of `gravity_stages_simd.cpp`.

#include "numbers/kernels_simd.hpp"

#include <cstddef>

namespace noether {

/// Coordinates of n bodies at eight stages, their masses, and what they feel, shape (n, 8) each.
struct BodiesInStages {
  const double *x, *y, *z, *m;
  double *ax, *ay, *az;  ///< sums so far, if there are any
  std::ptrdiff_t count;
  bool has_sums = true;
};

/// Adds the pull of every pair, each pair once.
using AttractInStages = void (*)(const BodiesInStages& bodies, double G, double softening2);

NOETHER_KERNELS(AttractInStages, attract_in_stages)

}  // namespace noether

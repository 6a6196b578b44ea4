#pragma once
/// Direct gravity in lanes: the interface of `gravity_simd.cpp`, which is compiled once per level of
/// `numbers/simd.hpp`.

#include <cstddef>
#include "numbers/kernels_simd.hpp"

namespace noether {

/// Bodies that attract: coordinates and masses, shape (count) each, and the row of every body among the particles.
struct AttractingBodies {
  const double *x, *y, *z, *m, *row;
  std::ptrdiff_t count;
};

/// What the particles of a block of rows feel from unit masses and G = 1, shape (rows) each. Coordinates may be read,
/// and results are written, up to the next multiple of eight rows.
struct AttractedRows {
  const double *x, *y, *z;
  double *ax, *ay, *az, *phi;  ///< sums so far; `phi`, the sum of m/r, only where energy is wanted
  std::ptrdiff_t first;        ///< the row of x[0] among the particles
  std::ptrdiff_t count;
};

/// Adds the pull of the bodies `from` to `to` (in this order) to each row; a row that is itself such a body skips it.
using AttractRows = void (*)(const AttractedRows& rows, const AttractingBodies& bodies, std::ptrdiff_t from,
                             std::ptrdiff_t to, double softening2);

struct GravityKernels {
  int lanes;
  AttractRows others, others_with_phi;  ///< no body from `from` to `to` is one of the rows
  AttractRows among, among_with_phi;    ///< some are
};

NOETHER_KERNELS(GravityKernels, gravity_kernels)

}  // namespace noether

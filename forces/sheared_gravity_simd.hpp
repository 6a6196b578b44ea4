#pragma once
/// Gravity of sliding images in lanes: the interface of `sheared_gravity_simd.cpp`, which is compiled once per level of
/// `numbers/simd.hpp`.

#include "forces/gravity_simd.hpp"

namespace noether {

/// A cell that repeats along x and y (`ShearedCell`), and what is added to squares of distances.
struct SlidingCell {
  double width, length, height, slope, softening2;
};

/// Adds to each row the pull of all bodies and of their eight nearest images beside them; a row that is itself a body
/// skips it with its images.
using AttractBySlidingImages = void (*)(const AttractedRows& rows, const AttractingBodies& bodies,
                                        const SlidingCell& cell);

struct ShearedGravityKernels {
  AttractBySlidingImages attract, attract_with_phi;
};

NOETHER_KERNELS(ShearedGravityKernels, sheared_gravity_kernels)

}  // namespace noether

#pragma once
/// Direct gravity of few bodies at eight stages at once: the interface of `gravity_stages_simd.cpp`.

#include "engine/simd.hpp"

#include <cstddef>

namespace noether {

/// Coordinates of n bodies at eight stages, their masses, and what they feel, shape (n, 8) each.
struct BodiesInStages {
  const double *x, *y, *z, *m;
  double *ax, *ay, *az;  ///< sums so far
  std::ptrdiff_t count;
};

/// Adds the pull of every pair, each pair once.
using AttractInStages = void (*)(const BodiesInStages& bodies, double G, double softening2);

namespace base {
extern const AttractInStages attract_in_stages;
}
#if NOETHER_SIMD_LEVELS
namespace avx2 {
extern const AttractInStages attract_in_stages;
}
namespace avx512 {
extern const AttractInStages attract_in_stages;
}
#endif

/// The kernel of the level in use.
inline AttractInStages attract_in_stages() {
#if NOETHER_SIMD_LEVELS
  return at_simd_level(base::attract_in_stages, avx2::attract_in_stages, avx512::attract_in_stages);
#else
  return base::attract_in_stages;
#endif
}

}  // namespace noether

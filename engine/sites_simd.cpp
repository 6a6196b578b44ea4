#include "engine/sites_simd.hpp"

#include "numbers/eight_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

/// Up to eight numbers from anywhere; the other lanes are 0.
NOETHER_EIGHT_INLINE Eight load_some(const double* from, std::ptrdiff_t count) {
  alignas(64) double own[8] = {};
  if (count >= 8) {
    __builtin_memcpy(own, from, sizeof own);
  } else {
    for (std::ptrdiff_t l = 0; l < count; ++l) own[l] = from[l];
  }
  return load_eight(own);
}

/// Numbers of eight bodies to every `stride`th place.
NOETHER_EIGHT_INLINE void spread(const Eight& a, double* to, std::ptrdiff_t stride, std::ptrdiff_t count) {
  alignas(64) double own[8];
  store_eight(a, own);
  if (count >= 8) {
    for (std::ptrdiff_t l = 0; l < 8; ++l) to[l * stride] = own[l];
  } else {
    for (std::ptrdiff_t l = 0; l < count; ++l) to[l * stride] = own[l];
  }
}

void place(const SiteColumns& c, const double* places, std::ptrdiff_t sites, std::ptrdiff_t from, std::ptrdiff_t to,
           std::ptrdiff_t site) {
  for (std::ptrdiff_t i = from; i < to; i += 8, site += 8 * sites) {
    const std::ptrdiff_t count = to - i;
    const EightRotations r = rotations(load_some(c.orientation[0] + i, count), load_some(c.orientation[1] + i, count),
                                       load_some(c.orientation[2] + i, count), load_some(c.orientation[3] + i, count));
    for (int axis = 0; axis < 3; ++axis) {
      const Eights row = r.row[axis];
      const Eight x = load_some(c.x[axis] + i, count);
      for (std::ptrdiff_t k = 0; k < sites; ++k) {
        const Eights in_body{Eight(places[3 * k]), Eight(places[3 * k + 1]), Eight(places[3 * k + 2])};
        const Eight arm = dot(row, in_body);
        spread(arm, c.arm[axis] + site + k, sites, count);
        spread(x + arm, c.at[axis] + site + k, sites, count);
      }
    }
  }
}

}  // namespace

extern const SiteKernels site_kernels;
const SiteKernels site_kernels{place};

}  // namespace noether::NOETHER_SIMD_LEVEL

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

/// Numbers of the three sites of eight bodies, body by body.
NOETHER_EIGHT_INLINE void spread_threes(const Eight (&a)[3], double* to) {
#if NOETHER_EIGHT_REGISTERS == 1
  const EightRegister x = a[0].r[0], y = a[1].r[0], z = a[2].r[0];
  EightRegister mixed[3] = {__builtin_shufflevector(x, y, 0, 8, 0, 1, 9, 0, 2, 10),
                            __builtin_shufflevector(x, y, 0, 3, 11, 0, 4, 12, 0, 5),
                            __builtin_shufflevector(x, y, 13, 0, 6, 14, 0, 7, 15, 0)};
  mixed[0] = __builtin_shufflevector(mixed[0], z, 0, 1, 8, 3, 4, 9, 6, 7);
  mixed[1] = __builtin_shufflevector(mixed[1], z, 10, 1, 2, 11, 4, 5, 12, 7);
  mixed[2] = __builtin_shufflevector(mixed[2], z, 0, 13, 2, 3, 14, 5, 6, 15);
  __builtin_memcpy(to, mixed, sizeof mixed);
#else
  for (int k = 0; k < 3; ++k) spread(a[k], to + k, 3, 8);
#endif
}

/// Rotations of eight bodies as matrices.
struct Rotations {
  Eights row[3];
};

NOETHER_EIGHT_INLINE Rotations rotations(const Eight& w, const Eight& x, const Eight& y, const Eight& z) {
  const Eight two(2), ww = w * w, xx = x * x, yy = y * y, zz = z * z;
  const Eight xy = x * y, xz = x * z, yz = y * z, wx = w * x, wy = w * y, wz = w * z;
  return {{{ww + xx - yy - zz, two * (xy - wz), two * (xz + wy)},
           {two * (xy + wz), ww - xx + yy - zz, two * (yz - wx)},
           {two * (xz - wy), two * (yz + wx), ww - xx - yy + zz}}};
}

void place(const SiteColumns& c, const double* places, std::ptrdiff_t sites, std::ptrdiff_t from, std::ptrdiff_t to,
           std::ptrdiff_t site) {
  for (std::ptrdiff_t i = from; i < to; i += 8, site += 8 * sites) {
    const std::ptrdiff_t count = to - i;
    const Rotations r = rotations(load_some(c.orientation[0] + i, count), load_some(c.orientation[1] + i, count),
                                  load_some(c.orientation[2] + i, count), load_some(c.orientation[3] + i, count));
    for (int axis = 0; axis < 3; ++axis) {
      const Eights row = r.row[axis];
      const Eight x = load_some(c.x[axis] + i, count);
      if (sites == 3 && count >= 8) {  // water
        Eight arm[3], at[3];
        for (int k = 0; k < 3; ++k) {
          arm[k] = dot(row, {Eight(places[3 * k]), Eight(places[3 * k + 1]), Eight(places[3 * k + 2])});
          at[k] = x + arm[k];
        }
        spread_threes(arm, c.arm[axis] + site);
        spread_threes(at, c.at[axis] + site);
        continue;
      }
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

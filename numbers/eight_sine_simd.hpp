#pragma once
/// Sine and cosine of eight small angles side by side. For `*_simd.cpp` alone.

#include "numbers/eight_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

struct EightTurns {
  Eight sine, cosine;
};

/// Of angles up to a quarter of pi, with the bits of `sine_cosine` (numbers/small_angle.hpp).
NOETHER_EIGHT_INLINE EightTurns sine_cosine(const Eight& x) {
  const Eight z = x * x, w = z * z;
  const Eight s = Eight(8.33333333332248946124e-03) +
                  z * (Eight(-1.98412698298579493134e-04) + z * Eight(2.75573137070700676789e-06)) +
                  z * w * (Eight(-2.50507602534068634195e-08) + z * Eight(1.58969099521155010221e-10));
  const Eight c = z * (Eight(4.16666666666666019037e-02) +
                       z * (Eight(-1.38888888888741095749e-03) + z * Eight(2.48015872894767294178e-05))) +
                  w * w *
                      (Eight(-2.75573143513906633035e-07) +
                       z * (Eight(2.08757232129817482790e-09) + z * Eight(-1.13596475577881948265e-11)));
  const Eight halved = Eight(0.5) * z, remainder = Eight(1) - halved;
  return {x + (z * x) * (Eight(-1.66666666666666324348e-01) + z * s),
          remainder + (((Eight(1) - remainder) - halved) + z * c)};
}

/// a where a number is above 0, else b.
NOETHER_EIGHT_INLINE Eight where_positive(const Eight& number, const Eight& a, const Eight& b) {
  return eight_of([&](int k) { return number.r[k] > EightRegister{} ? a.r[k] : b.r[k]; });
}

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL

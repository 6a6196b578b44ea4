#include "integrators/lie/rotations_simd.hpp"

#include "numbers/eight_sine_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

/// Component k of body i stands at [k][i].
template <int width> struct Columns {
  alignas(64) double at[width][8];

  NOETHER_EIGHT_INLINE void take(const double* rows) {
    for (int i = 0; i < 8; ++i) {
      for (int k = 0; k < width; ++k) at[k][i] = rows[width * i + k];
    }
  }
  NOETHER_EIGHT_INLINE void give(double* rows) const {
    for (int i = 0; i < 8; ++i) {
      for (int k = 0; k < width; ++k) rows[width * i + k] = at[k][i];
    }
  }
};

std::ptrdiff_t turn(const double* q, const double* u, double* out, std::ptrdiff_t from, std::ptrdiff_t to) {
  const Eight quarter(0.78539816339744828), half(0.5);
  Columns<4> places;
  Columns<3> angles;
  for (; from + 8 <= to; from += 8) {
    places.take(q + 4 * from);
    angles.take(u + 3 * from);
    const Eights by = load_eights(angles.at);
    const Eight angle = square_root(dot(by, by)), half_angle = half * angle;
    if (exceeding(half_angle, quarter) != 0) break;
    const EightTurns turns = sine_cosine(half_angle);
    const Eight per_angle = where_positive(angle, turns.sine / angle, half);
    const Eight b0 = where_positive(angle, turns.cosine, Eight(1)), b1 = per_angle * by.x, b2 = per_angle * by.y,
                b3 = per_angle * by.z;
    const Eight a0 = load_eight(places.at[0]), a1 = load_eight(places.at[1]), a2 = load_eight(places.at[2]),
                a3 = load_eight(places.at[3]);
    const Eight c[4] = {a0 * b0 - a1 * b1 - a2 * b2 - a3 * b3, a0 * b1 + a1 * b0 + a2 * b3 - a3 * b2,
                        a0 * b2 - a1 * b3 + a2 * b0 + a3 * b1, a0 * b3 + a1 * b2 - a2 * b1 + a3 * b0};
    const Eight length2 = c[0] * c[0] + c[1] * c[1] + c[2] * c[2] + c[3] * c[3];
    const Eight factor = Eight(1) - (length2 - Eight(1)) / Eight(2);
    for (int k = 0; k < 4; ++k) store_eight(c[k] * factor, places.at[k]);
    places.give(out + 4 * from);
  }
  return from;
}

}  // namespace

extern const RotationKernels rotation_kernels;
const RotationKernels rotation_kernels{turn};

}  // namespace noether::NOETHER_SIMD_LEVEL

#include "forces/tetrahedra_simd.hpp"

#include "numbers/eight_simd.hpp"

#include <math.h>

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

/// The numbers of eight particles in a column.
NOETHER_EIGHT_INLINE Eight gathered(const double* column, const std::int32_t* rows) {
#if defined(__AVX512F__)
  const __m256i eight = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(rows));
  return eight_of([&](int) {
    return EightRegister(_mm512_mask_i32gather_pd(_mm512_setzero_pd(), __mmask8(0xff), eight, column, 8));
  });
#else
  alignas(64) double own[8];
  for (int l = 0; l < 8; ++l) own[l] = column[rows[l]];
  return load_eight(own);
#endif
}

NOETHER_EIGHT_INLINE Eight logarithm(const Eight& a) {
  alignas(64) double own[8];
  store_eight(a, own);
  for (double& one : own) one = log(one);
  return load_eight(own);
}

/// The second Piola-Kirchhoff stress of a square of deformations, in its order xx, yy, zz, xy, xz, yz.
NOETHER_EIGHT_INLINE void stress_of(const TetrahedronGroups& g, const Eight (&c)[6], Eight (&s)[6]) {
  const Eight one(1.0), mu(g.mu), half_lambda(g.half_lambda);
  if (!g.neo_hookean) {
    const Eight xx = c[0] - one, yy = c[1] - one, zz = c[2] - one;
    const Eight p = half_lambda * ((xx + yy) + zz);
    s[0] = p + mu * xx;
    s[1] = p + mu * yy;
    s[2] = p + mu * zz;
    for (int k = 3; k < 6; ++k) s[k] = mu * c[k];
    return;
  }
  const Eight adjugate[6] = {c[1] * c[2] - c[5] * c[5], c[0] * c[2] - c[4] * c[4], c[0] * c[1] - c[3] * c[3],
                             c[4] * c[5] - c[3] * c[2], c[3] * c[5] - c[4] * c[1], c[3] * c[4] - c[5] * c[0]};
  const Eight j2 = c[0] * adjugate[0] + c[3] * adjugate[3] + c[4] * adjugate[4];
  const Eight by_inverse = half_lambda * logarithm(j2) - mu, part = one / j2;
  for (int k = 0; k < 6; ++k) s[k] = by_inverse * (part * adjugate[k]);
  for (int k = 0; k < 3; ++k) s[k] = s[k] + mu;
}

/// One group. @return lanes without det F > 0
NOETHER_EIGHT_INLINE unsigned one_group(const TetrahedronGroups& g, std::ptrdiff_t group) {
  const std::int32_t* const corners = g.corners + group * 32;
  const double* const shapes = g.shapes + group * 80;
  double* const slots = g.slots + group * 96;
  Eight shape[9], f[3][3];
  for (int k = 0; k < 9; ++k) shape[k] = load_eight(shapes + 8 * k);
  for (int i = 0; i < 3; ++i) {
    const Eight x = gathered(g.x[i], corners);
    const Eight a = gathered(g.x[i], corners + 8) - x, b = gathered(g.x[i], corners + 16) - x,
                c = gathered(g.x[i], corners + 24) - x;
    for (int j = 0; j < 3; ++j) f[i][j] = a * shape[j] + b * shape[3 + j] + c * shape[6 + j];
  }
  const auto square = [&](int i, int j) { return f[0][i] * f[0][j] + f[1][i] * f[1][j] + f[2][i] * f[2][j]; };
  const Eight c[6] = {square(0, 0), square(1, 1), square(2, 2), square(0, 1), square(0, 2), square(1, 2)};
  const Eight determinant = f[0][0] * (f[1][1] * f[2][2] - f[1][2] * f[2][1]) +
                            f[0][1] * (f[1][2] * f[2][0] - f[1][0] * f[2][2]) +
                            f[0][2] * (f[1][0] * f[2][1] - f[1][1] * f[2][0]);
  Eight s[6];
  stress_of(g, c, s);
  const Eight volume = load_eight(shapes + 72), none(0.0);
  for (int i = 0; i < 3; ++i) {
    const Eight p = f[i][0] * s[0] + f[i][1] * s[3] + f[i][2] * s[4],
                q = f[i][0] * s[3] + f[i][1] * s[1] + f[i][2] * s[5],
                r = f[i][0] * s[4] + f[i][1] * s[5] + f[i][2] * s[2];
    Eight force[3];
    for (int a = 0; a < 3; ++a) {
      force[a] = Eight(-0.0) - volume * (p * shape[3 * a] + q * shape[3 * a + 1] + r * shape[3 * a + 2]);
      store_eight(force[a], slots + 8 * (3 * a + i));
    }
    store_eight(Eight(-0.0) - ((force[0] + force[1]) + force[2]), slots + 8 * (9 + i));
  }
  return 0xffU & ~exceeding(determinant, none);
}

bool forces(const TetrahedronGroups& groups, std::ptrdiff_t from, std::ptrdiff_t to) {
  const TetrahedronGroups own = groups;
  unsigned inverted = 0;
  for (std::ptrdiff_t k = from; k < to; ++k) inverted |= one_group(own, k);
  return inverted == 0;
}

}  // namespace

extern const TetrahedronKernels tetrahedron_kernels;
const TetrahedronKernels tetrahedron_kernels{forces};

}  // namespace noether::NOETHER_SIMD_LEVEL

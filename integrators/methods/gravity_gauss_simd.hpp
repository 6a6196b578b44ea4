#pragma once
/// The arithmetic of collocation with eight stages for gravity alone: the interface of `gravity_gauss_simd.cpp`.

#include "numbers/kernels_simd.hpp"

#include <cstddef>

namespace noether {

/// Who attracts whom. Massive bodies come in pairs, each of which pulls both by one vector, the product of masses times
/// G in it; tracers are pulled by each massive body.
///
/// Pairs are numbered: those of massive bodies, the first with all behind it, then each tracer with all massive ones.
struct AttractingBodies {
  const std::ptrdiff_t *massive, *tracers;  ///< which bodies
  std::ptrdiff_t massive_count, tracer_count;
  const double *weight, *weight_low;    ///< of pairs: G m_i m_j / unit, or G m_j; rounded, and what is lost, relatively
  const double *inverse, *inverse_low;  ///< of massive bodies, in their order: unit / m, and what rounding has taken
};

/// What a step of n bodies begins with. Coordinates: all x, all y, all z.
struct StepBeginning {
  std::ptrdiff_t bodies;
  const double *y, *low;        ///< positions, then velocities, and what rounding has taken from them; shape (6 n)
  const double *c_h, *c_h_low;  ///< c_i h, shape (8)
  double grids[2];              ///< powers of two, above all |x| and all |v|
  double* on_grid;              ///< y rounded to 2^-52 of them, shape (6 n)
  double* known;                ///< the rest of x + c_i h v, shape (3 n, 8)
};

/// The end of a step: rates of shape (3 n, 8), padded to a multiple of eight variables.
struct StepEnd {
  std::ptrdiff_t n;  ///< 3 n
  const double* rates;
  /// b_j and b_j (1/2 - c_j), shape (8), and what rounding has taken from them.
  const double *b, *b_low, *odd, *odd_low;
  bool mirrored;          ///< b_j = b_(9-j), c_j = 1 - c_(9-j)
  std::ptrdiff_t middle;  ///< the stage r, from 0; that of mirrored ones is the fourth
  double h, half_h2, half_h2_low;
  double *x, *x_low, *v, *v_low;
};

struct GravityGaussKernels {
  /// (h2 + h2_low) (a + a_low) in two words; all of shape (8, 8)
  void (*scale_table)(double h2, double h2_low, const double* a, const double* a_low, double* out, double* out_low);
  void (*begin)(const StepBeginning& beginning);
  /// Differences of positions on the grid, and c_i h times those of velocities, of all pairs: shape (3, pairs, 8).
  void (*separations)(const AttractingBodies& bodies, const StepBeginning& beginning, double* out);
  /// Accelerations from displacements d and separations; both of shape (3 n, 8). @return the least r^2
  double (*attract)(const AttractingBodies& bodies, std::ptrdiff_t n, const double* d, const double* separations,
                    std::ptrdiff_t pairs, double* a);
  /// d_i = known + sum_j a_ji F_j of n variables; a of shape (8, 8)
  void (*displacements)(std::ptrdiff_t n, const double* rates, const double* a, const double* known, double* d);
  /// d_i = known + scale (sum_j w_ji F_j + sum_j w_(j+8)i G_j), the second for G alone that is not null
  void (*first_displacements)(std::ptrdiff_t n, const double* rates, const double* rates_before, const double* w,
                              double scale, const double* known, double* d);
  /// Whether the rate of some of n bodies has changed, at some stage, by more than `tolerance` of itself, or is none.
  bool (*moved)(std::ptrdiff_t n, const double* now, const double* before, double tolerance);
  /// x += h v + h^2 sum b (1 - c) F, v += h sum b F, from F_r and what other stages differ from it.
  void (*finish)(const StepEnd& end);
  /// Value and two derivatives of the polynomial through the rates of n variables, in the middle and at the end of a
  /// step of length 1: out of shape (6, stride), from weights of shape (6, 8), of mirrored stages or others.
  void (*derivatives)(std::ptrdiff_t n, const double* rates, const double* weights, bool mirrored, double* out,
                      std::ptrdiff_t stride);
};

NOETHER_KERNELS(GravityGaussKernels, gravity_gauss_kernels)

}  // namespace noether

#pragma once
/// The arithmetic of `EnckeGauss` at eight stages in lanes: the interface of `encke_simd.cpp`.

#include "numbers/kernels_simd.hpp"

#include <cstddef>
#include <cstdint>

namespace noether {

/// A body about the heaviest one in a step of `EnckeGauss`: vectors, and rows of eight stages.
struct EnckeBody {
  double x0[3] = {}, v0[3] = {};             ///< at the beginning of the step, relative to the heaviest body
  double gm = 0, mu = 0;                     ///< G m, G (M + m)
  double orbit[3][8] = {};                   ///< k
  double inverse_r2[8] = {}, mu_r3[8] = {};  ///< 1 / |k|^2, mu / |k|^3
  double upper[8][8] = {};                   ///< of the arc's derivative: f, g, f_x, f_eta, f_v, g_x, ...
  double away[3][8] = {}, place[3][8] = {}, pull[3][8] = {};  ///< d; q; G m q / |q|^3
  double perturbation[3][8] = {}, fresh[3][8] = {};           ///< p, as at hand, and by the sweep that goes on
  double rate_x[3][8] = {}, rate_v[3][8] = {};                ///< y'
  double change2[8] = {}, size2[8] = {};                      ///< of p by the last sweep, and the larger of both p
};

struct EnckeKernels {
  /// Arcs of a body, and their derivatives by its start, at the times `tau` after the beginning, shape (8).
  /// @return a bit for each stage whose arc is too long, or was not found to rounding
  std::uint8_t (*orbits)(EnckeBody& body, const double* tau);
  /// Departures, places and pulls from the rates. @param a  of shape (8, 8), the stages that are reached side by side
  void (*depart)(EnckeBody* bodies, std::ptrdiff_t n, const double* a, double h);
  /// Fresh perturbations by gravity. @return the largest G (m + m') / r^3 of two bodies
  double (*attract)(EnckeBody* bodies, std::ptrdiff_t n);
  /// Fresh perturbations as a polynomial has them in the next step, from those at hand. @param w  as `a`
  void (*predict)(EnckeBody* bodies, std::ptrdiff_t n, const double* w);
  /// The fresh perturbations become those at hand, and the rates follow.
  void (*take)(EnckeBody* bodies, std::ptrdiff_t n);
};

NOETHER_KERNELS(EnckeKernels, encke_kernels)

}  // namespace noether

#pragma once
/// The arithmetic of `EnckeGauss` at eight stages in lanes: the interface of `encke_simd.cpp`.

#include "integrators/methods/encke_row.hpp"
#include "numbers/kernels_simd.hpp"

#include <cstddef>

namespace noether {

/// The largest change of perturbations by a sweep, squared: relative to the largest of the body in the first sweep, and
/// over the square of the body's distance from the heaviest one. Both are infinite where one is not a number.
struct EnckeChange {
  double relative2 = 0, moves2 = 0;
};

/// Rows of eight stages, and tables of shape (8, 8), are aligned to 64 bytes.
struct EnckeKernels {
  /// Arcs of bodies, and their derivatives by the start, at the times tau[0] after the beginning, in two words; bodies
  /// know which are `missed`.
  void (*orbits)(EnckeBody* bodies, std::ptrdiff_t n, const EightWords& tau);
  /// Departures, places and pulls from the rates, and the first part of fresh perturbations, -mu_low q / |q|^3. @param
  /// a  of shape (8, 8), the stages that are reached side by side
  void (*depart)(EnckeBody* bodies, std::ptrdiff_t n, const double* a, double h);
  /// Adds gravity to fresh perturbations. @return the largest G (m + m') / r^3 of two bodies
  double (*attract)(EnckeBody* bodies, std::ptrdiff_t n);
  /// Perturbations as a polynomial has them in the next step, from those at hand, and rates. @param w  as `a`
  void (*predict)(EnckeBody* bodies, std::ptrdiff_t n, const double* w);
  /// The fresh perturbations become those at hand, and the rates follow. @param first  whether this is the first sweep
  EnckeChange (*take)(EnckeBody* bodies, std::ptrdiff_t n, bool first);
};

NOETHER_KERNELS(EnckeKernels, encke_kernels)

}  // namespace noether

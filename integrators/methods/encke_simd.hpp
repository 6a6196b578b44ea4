#pragma once
/// The arithmetic of `EnckeGauss` at eight stages in lanes: the interface of `encke_simd.cpp`.

#include "integrators/methods/encke_row.hpp"
#include "numbers/kernels_simd.hpp"

#include <cstddef>
#include <cstdint>

namespace noether {

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

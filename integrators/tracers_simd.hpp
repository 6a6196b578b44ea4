#pragma once
/// Tracers of a Wisdom-Holman splitting in lanes: the interface of `tracers_simd.cpp`.

#include "integrators/planet_row.hpp"
#include "numbers/kernels_simd.hpp"

namespace noether {

/// What tracers of some rows are to do.
struct TracerTask {
  const PathLetter* letters;
  std::ptrdiff_t count;
  const double* numbers;  ///< of the path
  std::ptrdiff_t planets;
  const double* attraction;  ///< G m by planet
  const double* near;  ///< by planet, r^2 over the squared distance from the star below which a pair is to be noted
  double star;         ///< G m_0
  double relativity;   ///< 6 (G m_0/c)^2; 0 without general relativity
  bool jacobi;         ///< coordinates; otherwise democratic ones
  bool compensated;    ///< whether what rounding takes is kept
  ExactArc exact;
  /// Takes down a tracer near a planet: with r^2 and the squared distance of the nearer one from the star.
  void (*note)(void* watch, std::ptrdiff_t tracer, std::ptrdiff_t planet, double r2, double nearer2, double time);
  void* watch;
};

/// How it went.
struct TracerReport {
  ArcReport arcs;
  std::ptrdiff_t lost_at = -1;  ///< the first letter at which an arc was not found; -1: none
  std::ptrdiff_t lost = -1;     ///< the first tracer of that letter
};

struct TracerKernels {
  /// Works out what rows hold as functions of x.
  void (*prepare)(ArcRow* rows, std::ptrdiff_t count);
  /// Moves tracers along the path.
  /// @param levels  by row
  /// @param first   number of the first tracer, for reports
  TracerReport (*follow)(const TracerTask& task, ArcRow* rows, const int* levels, std::ptrdiff_t count,
                         std::ptrdiff_t first);
};

NOETHER_KERNELS(TracerKernels, tracer_kernels)

}  // namespace noether

#pragma once
/// The flows of Wisdom-Holman with the planets in lanes: the interface of `wisdom_holman_simd.cpp`.

#include "integrators/planet_row.hpp"
#include "numbers/kernels_simd.hpp"

namespace noether {

struct PlanetKernels {
  /// Works out what the rows hold as functions of x.
  void (*prepare)(const PlanetRows& planets);
  /// Kepler arcs of all planets.
  ArcReport (*drift)(const PlanetRows& planets, const ArcTask& task);
  /// The kick over h, predictions following the jumps of democratic coordinates. @return whether two planets are so
  /// near that they are to be noted
  bool (*kick)(const PlanetRows& planets, double h, bool predicted);

  // Of kernels, in Jacobi coordinates; a(x) are the accelerations of a kick.
  /// Makes h a(x) the direction of the rows.
  /// @param known  the forces in the rows are those at x
  /// @return whether two planets are so near that they are to be noted; false where the forces are known
  bool (*accelerate)(const PlanetRows& planets, double h, bool known);
  /// The kick over h by the accelerations at x plus the direction.
  void (*kick_beside)(const PlanetRows& planets, double h);
  /// The kick by h (direction . grad) a, where the rows hold the forces at x.
  void (*kick_by_gradient)(const PlanetRows& planets, double h);
};

NOETHER_KERNELS(PlanetKernels, planet_kernels)

}  // namespace noether

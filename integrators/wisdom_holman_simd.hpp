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
};

NOETHER_KERNELS(PlanetKernels, planet_kernels)

}  // namespace noether

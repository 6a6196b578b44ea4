#pragma once
/// The flows of Wisdom-Holman for eight systems in lanes: the interface of `planet_systems_simd.cpp`.

#include "integrators/planet_systems_row.hpp"
#include "numbers/kernels_simd.hpp"

namespace noether {

struct PlanetSystemKernels {
  /// Works out what the rows hold as functions of x.
  void (*prepare)(const SystemRows& systems);
  /// Kepler arcs of all planets.
  ArcReport (*drift)(const SystemRows& systems, const ArcTask& task);
  /// Where planets are relative to their stars.
  void (*place)(const SystemRows& systems);
  /// The kick over h, behind `place`.
  void (*kick)(const SystemRows& systems, double h);
};

NOETHER_KERNELS(PlanetSystemKernels, planet_system_kernels)

}  // namespace noether

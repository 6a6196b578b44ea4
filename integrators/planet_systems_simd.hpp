#pragma once
/// The flows of Wisdom-Holman for eight systems in lanes: the interface of `planet_systems_simd.cpp`.

#include "integrators/planet_systems_row.hpp"
#include "numbers/kernels_simd.hpp"

namespace noether {

struct PlanetSystemKernels {
  /// Works out what the rows hold as functions of x.
  void (*prepare)(const SystemRows& systems);
  /// Kepler arcs of all planets, and of their changes.
  ArcReport (*drift)(const SystemRows& systems, const ArcTask& task);
  /// Where planets are relative to their stars.
  void (*place)(const SystemRows& systems);
  /// Accelerations of all bodies, and of changes, behind `place`.
  void (*attract)(const SystemRows& systems);
  /// The kick over h by these.
  void (*kick)(const SystemRows& systems, double h);
  /// |dx|^2 and |dv|^2 of a change, in inertial coordinates, as they are after arcs over `arcs` or a kick over `kick`,
  /// one of them 0, of which nothing is done.
  /// @param squares  shape (2, 8)
  void (*measure)(const SystemRows& systems, std::ptrdiff_t change, double arcs, double kick, double* squares);
};

NOETHER_KERNELS(PlanetSystemKernels, planet_system_kernels)

}  // namespace noether

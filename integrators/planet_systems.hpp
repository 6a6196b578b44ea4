#pragma once
/// Planetary systems side by side: the Wisdom-Holman splitting of eight systems in lanes.

#include "integrators/system_lanes.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace noether {

/// What eight planetary systems have in common.
struct PlanetSystemsOptions {
  double G = 0;                     ///< [length^3/mass/time^2]
  std::vector<std::int64_t> order;  ///< particles in the order of Jacobi coordinates, the star first
  std::optional<double> light;      ///< speed of light of `gr_potential`; empty without [length/time]
  double G_of_light = 0;            ///< the constant in it [length^3/mass/time^2]
  ForceField<double> others = {};   ///< that depend on positions and time; with these no general relativity in `light`
  bool compensated = false;         ///< whether what rounding takes from sums is kept
};

/// Systems of planets, without tracers, on Kepler arcs in Jacobi coordinates and kicked by each other (letters A and B
/// of `WisdomHolman`): of eight systems each planet is in one register, so that nothing has to be moved between lanes.
/// @param like  one of them; all have its size and its ids
/// @throws Error  for other forces that have no lanes
std::unique_ptr<SystemLanes> planet_systems(PlanetSystemsOptions options, const ParticleSystem<double>& like);

}  // namespace noether

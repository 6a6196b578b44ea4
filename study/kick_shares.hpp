#pragma once
/// What the kicks of multiple time steps have of a vibration.

#include "scene/scene.hpp"

#include <map>

namespace noether {

/// The parts that the kicks of each letter have in omega^2 of the fastest vibration at the start; their sum is 1. Empty
/// where that is no mode of each of them alone, to 1e-6, and for constraints, bodies, more than 64 particles, and
/// forces in several kicks.
/// @cost for each letter a product for each coordinate
std::map<char, double> kick_shares(const Scene& scene);

}  // namespace noether

#pragma once
/// A rigid molecule of three sites: what is constant of it.

#include "constraints/molecule_row.hpp"

#include <array>

namespace noether {

/// Writes what is constant of a molecule into a lane of several, whose masses are the same.
/// @param inverse_masses  of the three atoms
/// @param lengths2        squared: of 0-1, 0-2 and 1-2
void put_triangle(RigidTriangles& all, int lane, const std::array<double, 3>& inverse_masses,
                  const std::array<double, 3>& lengths2);

}  // namespace noether

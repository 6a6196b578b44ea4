#pragma once
/// The builder of blocks that deform.

#include "engine/description.hpp"
#include "engine/particle_system.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace noether {

/// A box of cells, each divided into six tetrahedra about the diagonal from its lowest to its highest corner.
///
/// Particles are the corners of cells, node_0_0_0, node_0_0_1 and so on, with a quarter of the mass of each of their
/// tetrahedra; at rest the box lies about the origin, along the axes. Its start is, one after the other: stretched
/// along each axis; bent about the y axis, so that what lay along x becomes an arc of the angle `bend`; moved to
/// `center`. Velocities are those of a body that is not deformed any further,
///
///     v = velocity + angular_velocity x (x - center)
///
/// The mesh has one region, `block`, and six surfaces: x_low, x_high, y_low, y_high, z_low, z_high.
/// @source Kuhn1960
struct Block {
  std::vector<std::int64_t> cells = {};                ///< three numbers, along x, y and z
  std::array<double, 3> size = {0, 0, 0};              ///< of the box at rest [length]
  double density = 0;                                  ///< at rest [mass/length^3]
  std::array<double, 3> stretch = {1, 1, 1};           ///< factors along the axes
  double bend = 0;                                     ///< of the axis along x [angle]
  std::array<double, 3> center = {0, 0, 0};            ///< [length]
  std::array<double, 3> velocity = {0, 0, 0};          ///< [length/time]
  std::array<double, 3> angular_velocity = {0, 0, 0};  ///< [1/time]

  static constexpr auto describe() {
    return part<Block>(
        "block", "a box that deforms, divided into tetrahedra", source("Kuhn1960"),
        field<&Block::cells>("cells", "1", "number of cells along x, y and z, of six tetrahedra each")
            .required("[4, 4, 4]"),
        field<&Block::size>("size", "length", "lengths of the edges at rest").required("[1, 1, 1]"),
        field<&Block::density>("density", "density", "mass per volume at rest").required("1"),
        field<&Block::stretch>("stretch", "1", "factors along x, y and z by which it is stretched at the start"),
        field<&Block::bend>("bend", "angle", "angle of the arc into which its length along x is bent at the start"),
        field<&Block::center>("center", "length", "where its centre is"),
        field<&Block::velocity>("velocity", "length/time", "of its centre"),
        field<&Block::angular_velocity>("angular_velocity", "1/time", "with which it turns about its centre"));
  }
  void check() const;
  /// @throws Error  as `check`
  /// @cost O(cells)
  ParticleSystem<double> build(const UnitSystem& units = unit_system("reduced")) const;
};

}  // namespace noether

#pragma once
/// Charges in the order of the columns of a mesh that they are in.

#include "engine/particle_system.hpp"
#include "forces/charge_row.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace noether::detail {

/// Columns of cells of a mesh, a rectangle of x and y each, and who is in them.
///
/// A tile is at least as wide as what a spline reaches beyond its cell, so that charges of every second tile along both
/// axes never meet at a point. The number of tiles along an axis is even, or 1.
class ChargeTiles {
 public:
  /// @param points  of the mesh @param reach  of a spline beyond its cell @param charges  how many there are
  void lay(const std::array<std::int64_t, 3>& points, int reach, Index charges);
  /// Sorts the particles with a charge.
  void sort(const ParticleSystem<double>& s, const double* charges);

  /// Those with a charge, tile by tile.
  Index size() const { return begins_.empty() ? 0 : begins_.back(); }
  const MeshPlace* places() const { return places_.data(); }
  /// Where a particle is among them; below 0 without a charge.
  Index place_of(Index particle) const { return at_[static_cast<std::size_t>(particle)]; }
  /// Tiles along x and y; tile t is number t % y of line t / y.
  const std::array<Index, 2>& tiles() const { return tiles_; }
  Index begin(Index tile) const { return begins_[static_cast<std::size_t>(tile)]; }
  /// Most charges that can meet at a point.
  Index most_together() const { return most_together_; }

 private:
  void count_together();

  std::array<std::int64_t, 3> points_{};
  std::array<Index, 2> tiles_{1, 1};
  std::array<std::vector<Index>, 2> tile_at_;  ///< of each cell along x, that of its line; along y, in a line
  std::vector<Index> counts_;                  ///< of each share of the particles, shape (shares, tiles)
  std::vector<Index> begins_;
  std::vector<Index> at_;  ///< of every particle, while they are sorted its tile
  std::vector<MeshPlace> places_;
  std::vector<Index> layer_at_,
      together_;  ///< layers of tiles by cells along z; charges in them, shape (tiles, layers)
  Index layers_ = 1;
  Index most_together_ = 0;
};

}  // namespace noether::detail

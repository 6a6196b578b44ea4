#pragma once
/// The space particles live in: open, or a cell that repeats in every direction.

#include "numbers/types.hpp"

#include <cmath>
#include <cstdint>
#include <type_traits>

namespace noether {

struct BoxAxis;

namespace detail {
/// The whole number nearest to a number of any type, in that type: of a dual number without slope, of packs by lane.
template <class Real> Real nearest_whole(const Real& x) {
  if constexpr (requires { x.value.value; }) {
    return Real(nearest_whole(x.value));
  } else if constexpr (requires { x.slope; }) {
    return Real(nearest_whole(x.value));
  } else if constexpr (requires { x.lane; }) {
    Real whole = x;
    for (auto& lane : whole.lane) lane = std::nearbyint(lane);
    return whole;
  } else if constexpr (requires { static_cast<double>(x); }) {
    return Real(std::nearbyint(static_cast<double>(x)));
  } else {
    return Real(0);  // number types of tests, in open space
  }
}
}  // namespace detail

/// Open space, or a periodic cell with edges along the axes and a corner in the origin.
///
/// Positions in a periodic cell lie in [0, edge) on a grid whose spacing is a power of two, one unit in the last place
/// of the edge, so that differences, images and wrapping are exact: what is computed from positions cannot depend on
/// where the cell is cut. How often a particle has crossed the cell is counted beside, in whole numbers.
class Box {
 public:
  static Box open() { return {}; }
  /// A cell that repeats in three directions. @param edges  [length]
  /// @throws Error  unless every edge is a length above 0
  static Box periodic(const Vec3<double>& edges);

  bool is_periodic() const { return edges_[0] > 0; }
  /// Lengths of the edges [length]; 0 in open space.
  const Vec3<double>& edges() const { return edges_; }
  /// [length^3]; 0 in open space.
  double volume() const { return edges_[0] * edges_[1] * edges_[2]; }
  /// Distance between two neighboring points of the grid along axis `k` [length].
  double spacing(int k) const { return spacing_[k]; }

  /// `d` or the shortest of its periodic images; exact for positions in the cell [length].
  template <class Real> Vec3<Real> minimum_image(Vec3<Real> d) const {
    if (!is_periodic()) return d;
    for (int k = 0; k < 3; ++k) {
      if constexpr (std::is_same_v<Real, double>) {
        if (std::abs(d[k]) <= 0.5 * edges_[k]) continue;  // nearly always, and a division costs more than the question
      }
      d[k] -= Real(edges_[k]) * detail::nearest_whole(d[k] / Real(edges_[k]));
    }
    return d;
  }

  /// A length along axis `k`, rounded to the grid.
  double on_grid(int k, double length) const { return std::nearbyint(length / spacing_[k]) * spacing_[k]; }

  /// Brings a coordinate back into [0, edge) and counts the cells it has crossed. One that has crossed more than 2^30
  /// becomes NaN, which ends a run as `diverged`.
  template <class Real> void wrap(int k, Real& x, std::int32_t& image) const {
    const Real edge(edges_[k]);
    if (x >= Real(0) && x < edge) return;
    using std::floor;
    double cells = static_cast<double>(floor(x / edge));
    if (!(std::abs(cells) < most_cells)) {
      if (x - x == Real(0)) x = Real(0) / Real(0) * x;
      return;
    }
    if constexpr (std::is_same_v<Real, double>) {
      x = std::fma(-edge, cells, x);
    } else {
      x -= edge * Real(cells);
    }
    // The quotient is rounded: one cell too many or too few is set right here.
    if (x < Real(0)) x += edge, --cells;
    if (x >= edge) x -= edge, ++cells;
    image += static_cast<std::int32_t>(cells);
  }

  /// Rounds `count` coordinates along axis `k` to the grid and brings each back into [0, edge) as by `wrap`.
  void bring_in(int k, double* x, std::int32_t* image, Index count) const;

  /// x -> x + d for one coordinate in the cell; `d` is rounded to the grid, and so the sum is exact.
  void shift(int k, double d, double& x, std::int32_t& image) const;

  /// x -> x + h v along axis `k` for `count` coordinates in the cell, each as by `shift`.
  void advance(int k, double h, const double* v, double* x, std::int32_t* image, Index count) const;

  bool operator==(const Box& other) const { return edges_ == other.edges_; }

 private:
  static constexpr double most_cells = 1 << 30;

  BoxAxis axis(int k) const;

  Vec3<double> edges_ = Vec3<double>::Zero(), spacing_ = Vec3<double>::Zero();
};

}  // namespace noether

#pragma once
/// Points sorted into cells, so that those near a place are found without asking all.

#include "engine/column.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace noether {

/// Sorts points into cells and gives the runs of sorted points that can be near a box.
///
/// Cells follow each other along x, back and forth from row to row, and rows along Hilbert's curve in y and z: points
/// which follow each other are near each other, and what one row needs is still in the cache for the next. Layers
/// without a point are left out where space is mostly empty.
/// @cost O(n) time and memory, however far the points are from each other
/// @source Hilbert1891
class CellGrid {
 public:
  /// A box along the axes.
  struct Bounds {
    std::array<double, 3> lower, upper;
  };

  /// Sorts `count` points for searches up to `range`. Coordinates that are no numbers are somewhere.
  void sort(const std::array<const double*, 3>& coordinates, Index count, double range);

  /// Place k of the sorted points is held by point `order()[k]`.
  const std::vector<std::int32_t>& order() const { return order_; }
  /// Gives back the memory of `order`, which `near` does without.
  void forget_order() {
    cells_ = std::vector<std::int32_t>();
    order_ = std::vector<std::int32_t>();
  }
  /// Memory held. @cost O(1)
  std::size_t bytes() const {
    return sizeof(std::int32_t) * (rows_.capacity() + cells_.capacity() + start_.capacity() + order_.capacity());
  }
  /// Longest edge of the cells [length].
  double edge() const { return std::max({axes_[0].edge, axes_[1].edge, axes_[2].edge}); }

  /// Calls `run(begin, end)` for runs of sorted places that hold all points up to `range` from a box.
  template <class Run> void near(const Bounds& box, double range, const Run& run) const {
    const auto [from_z, to_z] = axes_[2].cells(box.lower[2] - range, box.upper[2] + range);
    for (Index iz = from_z; iz < to_z; ++iz) {
      const double dz = axes_[2].distance(iz, box.lower[2], box.upper[2]);
      const double yz2 = range * range - dz * dz;
      if (!(yz2 >= 0)) continue;
      const double reach_y = std::sqrt(yz2);
      const auto [from_y, to_y] = axes_[1].cells(box.lower[1] - reach_y, box.upper[1] + reach_y);
      for (Index iy = from_y; iy < to_y; ++iy) {
        const double dy = axes_[1].distance(iy, box.lower[1], box.upper[1]);
        const double x2 = yz2 - dy * dy;
        if (!(x2 >= 0)) continue;
        const double reach_x = std::sqrt(x2);
        const auto [from_x, to_x] = axes_[0].cells(box.lower[0] - reach_x, box.upper[0] + reach_x);
        if (from_x >= to_x) continue;
        const Index a = cell(from_x, iy, iz), b = cell(to_x - 1, iy, iz);
        run(Index{start_[at(std::min(a, b))]}, Index{start_[at(std::max(a, b) + 1)]});
      }
    }
  }

 private:
  /// The cells along one axis: of one length, or only those that hold points.
  struct Axis {
    double lower = 0, edge = 1, inverse_edge = 1;
    Index size = 1;
    std::vector<double> occupied;  ///< numbers of the cells that are there; empty: all are
    double rounding = 0;           ///< a point may lie so far outside of its cell [length]

    /// Grows with x, so that what lies between two points lies between their cells.
    double number(double x) const { return std::floor((x - lower) * inverse_edge); }
    void set_edge(double length) {
      edge = length;
      inverse_edge = 1 / length;
    }
    Index cell(double x) const;
    /// The cells that an interval meets, up to one behind the last.
    std::pair<Index, Index> cells(double from, double to) const {
      if (!occupied.empty()) {
        return {std::lower_bound(occupied.begin(), occupied.end(), number(from)) - occupied.begin(),
                std::upper_bound(occupied.begin(), occupied.end(), number(to)) - occupied.begin()};
      }
      const double first = (from - lower) * inverse_edge, last = (to - lower) * inverse_edge;
      const auto most = static_cast<double>(size);
      return {first >= most ? size
              : first > 0   ? static_cast<Index>(first)
                            : 0,
              last >= most ? size
              : last >= 0  ? static_cast<Index>(last) + 1
                           : 0};
    }
    /// Least distance from an interval to a point of a cell, or less [length].
    double distance(Index i, double from, double to) const {
      const double begin = lower + edge * (occupied.empty() ? static_cast<double>(i) : occupied[at(i)]);
      return std::max({0.0, begin - to - rounding, from - (begin + edge) - rounding});
    }
  };

  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  Index cell(Index ix, Index iy, Index iz) const {
    const Index row = rows_[at(iz * axes_[1].size + iy)];
    return row * axes_[0].size + (row % 2 == 0 ? ix : axes_[0].size - 1 - ix);
  }
  void lay_axes(const std::array<const double*, 3>& coordinates, Index count, double range);
  void order_rows();

  std::array<Axis, 3> axes_;
  std::vector<std::int32_t> rows_;  ///< place of a row of cells along the curve, shape (cells along z, along y)
  std::vector<std::int32_t> cells_, start_, order_;
};

}  // namespace noether

#include "neighbors/cell_grid.hpp"

#include "numbers/parallel.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace noether {

namespace {

/// More cells than this for each point are mostly empty, and cost more than they save.
constexpr double most_cells_per_point = 8;
/// Points that one cell holds where space is evenly filled; short along x, where runs are cut. And cells at their
/// widest, in ranges of the search. (What costs a search least in melts with cutoffs of 1.12 and 2.5 sigma.)
constexpr double points_per_cell = 6;
constexpr double width_to_length = 4;
constexpr double widest_cell = 1.4;

struct Interval {
  double lower = std::numeric_limits<double>::infinity(), upper = -std::numeric_limits<double>::infinity();

  /// Grows to hold another one too.
  Interval& operator+=(const Interval& other) {
    lower = std::min(lower, other.lower);
    upper = std::max(upper, other.upper);
    return *this;
  }
};

Interval extent_of(const double* x, Index count) {
  const Interval all = reduce(count, Interval{}, [&](Index begin, Index end) {
    Interval block;
    for (Index i = begin; i < end; ++i) {
      if (std::abs(x[i]) < 1e300) block += {x[i], x[i]};
    }
    return block;
  });
  return all.lower <= all.upper ? all : Interval{0, 0};
}

}  // namespace

namespace {

/// Place of (y, z) along Hilbert's curve through a square of `size` x `size` places, a power of two.
std::uint64_t hilbert(std::uint64_t size, std::uint64_t y, std::uint64_t z) {
  std::uint64_t place = 0;
  for (std::uint64_t half = size / 2; half > 0; half /= 2) {
    const bool right = (y & half) != 0, upper = (z & half) != 0;
    place += half * half * (right ? (upper ? 2 : 3) : (upper ? 1 : 0));
    if (upper) continue;
    if (right) {
      y = size - 1 - y;
      z = size - 1 - z;
    }
    std::swap(y, z);
  }
  return place;
}

}  // namespace

/// Numbers the rows along the curve.
void CellGrid::order_rows() {
  const Index along_y = axes_[1].size, along_z = axes_[2].size;
  const auto size = std::bit_ceil(static_cast<std::uint64_t>(std::max(along_y, along_z)));
  std::vector<std::pair<std::uint64_t, std::int32_t>> curve;
  curve.reserve(at(along_y * along_z));
  for (Index iz = 0; iz < along_z; ++iz) {
    for (Index iy = 0; iy < along_y; ++iy) {
      curve.emplace_back(hilbert(size, static_cast<std::uint64_t>(iz), static_cast<std::uint64_t>(iy)),
                         static_cast<std::int32_t>(iz * along_y + iy));
    }
  }
  std::sort(curve.begin(), curve.end());
  rows_.resize(curve.size());
  for (std::size_t k = 0; k < curve.size(); ++k) rows_[at(curve[k].second)] = static_cast<std::int32_t>(k);
}

Index CellGrid::Axis::cell(double x) const {
  if (occupied.empty()) {
    const double wanted = (x - lower) * inverse_edge;
    return wanted >= static_cast<double>(size) ? size - 1 : wanted > 0 ? static_cast<Index>(wanted) : 0;
  }
  const auto found = std::lower_bound(occupied.begin(), occupied.end(), number(x));
  return found == occupied.end() ? size - 1 : found - occupied.begin();
}

void CellGrid::lay_axes(const std::array<const double*, 3>& coordinates, Index count, double range) {
  std::array<double, 3> length{};
  double volume = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const Interval all = extent_of(coordinates[k], count);
    length[k] = std::max(all.upper - all.lower, range);
    volume *= length[k];
    axes_[k] = Axis{all.lower, 1, 1, 1, {}, 0x1p-49 * (std::abs(all.lower) + length[k])};
  }
  const double even =
      std::cbrt(points_per_cell * width_to_length * volume / static_cast<double>(std::max<Index>(count, 1)));
  const double width = std::clamp(even, range / 4, widest_cell * range);
  double cells = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    Axis& axis = axes_[k];
    axis.set_edge(k == 0 ? width / width_to_length : width);
    cells *= std::floor(length[k] / axis.edge) + 1;
  }
  const double most = most_cells_per_point * static_cast<double>(count) + 4096;
  const auto fill_all = [&] {
    for (std::size_t k = 0; k < 3; ++k) {
      axes_[k].occupied.clear();
      axes_[k].size = static_cast<Index>(std::floor(length[k] / axes_[k].edge)) + 1;
    }
  };
  // Only layers of cells that hold points; how many cells they cross in.
  const auto occupy_all = [&] {
    double crossings = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      Axis& axis = axes_[k];
      axis.occupied.resize(at(count));
      for (Index i = 0; i < count; ++i) {
        const double number = axis.number(coordinates[k][i]);
        axis.occupied[at(i)] = std::isfinite(number) ? number : 0;
      }
      std::sort(axis.occupied.begin(), axis.occupied.end());
      axis.occupied.erase(std::unique(axis.occupied.begin(), axis.occupied.end()), axis.occupied.end());
      axis.size = static_cast<Index>(axis.occupied.size());
      crossings *= static_cast<double>(axis.size);
    }
    return crossings;
  };
  if (cells <= most) return fill_all();
  if (occupy_all() <= most) return;
  // A thin gas all over: longer cells hold few points too.
  const double longer = std::cbrt(cells / (static_cast<double>(count) + 4096)) * 1.01;
  const std::array<double, 3> edges = {axes_[0].edge, axes_[1].edge, axes_[2].edge};
  cells = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    axes_[k].set_edge(std::min(edges[k] * longer, length[k]));
    cells *= std::floor(length[k] / axes_[k].edge) + 1;
  }
  if (cells <= most && std::isfinite(longer)) return fill_all();
  // And somebody far away from it.
  for (std::size_t k = 0; k < 3; ++k) axes_[k].set_edge(edges[k]);
  do {
    for (Axis& axis : axes_) axis.set_edge(1.5 * axis.edge);
  } while (occupy_all() > most);
}

void CellGrid::sort(const std::array<const double*, 3>& coordinates, Index count, double range) {
  lay_axes(coordinates, count, range);
  order_rows();
  const Index total = axes_[0].size * axes_[1].size * axes_[2].size;
  cells_.resize(at(count));
  start_.assign(at(total + 1), 0);
  order_.resize(at(count));
  for_blocks(count, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const auto along = [&](std::size_t k) { return axes_[k].cell(coordinates[k][i]); };
      cells_[at(i)] = static_cast<std::int32_t>(cell(along(0), along(1), along(2)));
    }
  });
  for (const std::int32_t c : cells_) ++start_[at(c)];
  std::int32_t sum = 0;
  for (auto& start : start_) sum += std::exchange(start, sum);
  // Each start moves on to the start of the next cell, and back.
  for (Index i = 0; i < count; ++i) order_[at(start_[at(cells_[at(i)])]++)] = static_cast<std::int32_t>(i);
  for (Index c = total; c > 0; --c) start_[at(c)] = start_[at(c - 1)];
  start_[0] = 0;
}

}  // namespace noether

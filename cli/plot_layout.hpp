#pragma once
/// Where the panels of a picture stand on the page.

#include "cli/plot_data.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace noether {

/// A rectangle on the page, in points from the lower left.
struct PlotArea {
  double left = 0, low = 0, wide = 0, high = 0;
};

/// The page of a picture: what is seen in space on the left or above, other panels beside or below it, the legend at
/// the lower edge.
class PlotLayout {
 public:
  explicit PlotLayout(const PlotData& data);

  double width() const { return width_; }
  double height() const { return height_; }
  /// Whether the method has room beside the title; it stands below it elsewhere.
  bool method_beside_title() const { return beside_; }
  /// Where view `v` of picture `k` of orbits stands.
  const PlotArea& orbits(std::size_t k, std::size_t v) const { return orbits_[k][v]; }
  const PlotArea& box(std::size_t k) const { return boxes_[k]; }
  const PlotArea& panel(std::size_t k) const { return panels_[k]; }
  /// Left lower corners of the entries of the legend.
  const std::vector<PlotPoint>& legend() const { return legend_; }

 private:
  void place_legend(const PlotData& data);
  double place_space(const PlotData& data, double left, double top);
  void place_grid(const PlotData& data, const PlotArea& room, std::size_t columns);

  double width_ = 0, height_ = 0;
  bool beside_ = true;
  double box_size_ = 0;
  std::vector<std::vector<PlotArea>> orbits_;
  std::vector<PlotArea> boxes_, panels_;
  std::vector<PlotPoint> legend_;
  double legend_height_ = 0;
};

}  // namespace noether

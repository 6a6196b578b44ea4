#include "cli/plot_layout.hpp"

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

constexpr double square_size = 430, title_height = 62, legend_row = 20;
constexpr double large_box = 560, alone_width = 470, column_width = 330, least_height = 150, between_rows = 78,
                 between_views = 62, bar_room = 108;
constexpr double left_margin = 74, right_margin = 30, bottom_margin = 58, panel_gap = 74, column_gap = 76;

/// Width and height of everything that is seen in space.
struct Extent {
  double wide = 0, high = 0;
};

/// How large the second axis of a view is beside the first, in points.
double strip(double part, double whole) { return square_size * part / whole; }

Extent extent_of(const PlotOrbits& picture) {
  Extent size{square_size, square_size};
  for (std::size_t v = 1; v < picture.views.size(); ++v) {
    const PlotView& view = picture.views[v];
    if (view.across == picture.views[0].across) {
      size.high += between_views + strip(view.high.y - view.low.y, view.high.x - view.low.x);
    } else {
      size.wide += between_views + 14 + strip(view.high.x - view.low.x, view.high.y - view.low.y);
    }
  }
  return size;
}

Extent space_of(const PlotData& data, double box) {
  Extent all;
  std::size_t count = 0;
  const auto add = [&](const Extent& one) {
    all.wide += one.wide + (count++ > 0 ? panel_gap : 0);
    all.high = std::max(all.high, one.high);
  };
  for (const PlotOrbits& picture : data.orbits) add(extent_of(picture));
  for (std::size_t k = 0; k < data.boxes.size(); ++k) add({box, box});
  for (const PlotPanel& panel : data.panels) {
    if (panel.large) add({square_size + (panel.colors ? bar_room : 0), square_size});
  }
  return all;
}

double rows_height(std::size_t rows) {
  return static_cast<double>(rows) * least_height + static_cast<double>(rows - 1) * between_rows;
}

}  // namespace

PlotLayout::PlotLayout(const PlotData& data) : boxes_(data.boxes.size()), panels_(data.panels.size()) {
  const auto small = static_cast<std::size_t>(
      std::count_if(data.panels.begin(), data.panels.end(), [](const PlotPanel& p) { return !p.large; }));
  box_size_ = small > 4 ? large_box : square_size;  // beside three rows of panels
  const Extent space = space_of(data, box_size_);
  const bool nothing = !(space.wide > 0), below = space.wide > 1.5 * square_size && data.boxes.empty() && small > 2;
  std::size_t columns = small > 3 ? 2 : 1;
  if (below) columns = 3;
  columns = std::min(columns, std::max<std::size_t>(small, 1));
  const std::size_t rows = (small + columns - 1) / columns;
  const double between = static_cast<double>(columns - 1) * column_gap;
  double grid_width = columns == 1 ? alone_width : static_cast<double>(columns) * column_width + between;
  if (below) grid_width = space.wide;
  const double grid_height = small > 0 ? rows_height(rows) : 0;

  width_ = left_margin + right_margin + (below || small == 0 ? space.wide : 0);
  if (!below && small > 0) width_ += space.wide + grid_width + (nothing ? 0 : panel_gap + 12);
  place_legend(data);
  const double bottom = bottom_margin + legend_height_;
  const double tall = below ? space.high + between_rows + grid_height : std::max(space.high, grid_height);
  beside_ = width_ - 60 - 10.5 * static_cast<double>(data.title.size()) > 7 * static_cast<double>(data.subtitle.size());
  height_ = bottom + tall + title_height + (beside_ ? 0 : 18);
  const double top = bottom + tall;
  place_space(data, left_margin, top);
  if (below) {
    place_grid(data, {left_margin, bottom, grid_width, grid_height}, columns);
  } else {
    place_grid(data, {width_ - right_margin - grid_width, bottom, grid_width, tall}, columns);
  }
}

void PlotLayout::place_legend(const PlotData& data) {
  if (data.legend.empty()) return;
  const double room = width_ - left_margin - right_margin;
  double x = 0;
  int rows = 1;
  for (const PlotLegend& entry : data.legend) {
    const double wide = 40 + 7.4 * static_cast<double>(entry.name.size());
    if (x > 0 && x + wide > room) x = 0, ++rows;
    legend_.push_back({left_margin + 6 + x, static_cast<double>(rows)});
    x += wide;
  }
  legend_height_ = legend_row * rows;
  for (PlotPoint& at : legend_) at.y = legend_row * (rows - at.y + 0.6);
}

double PlotLayout::place_space(const PlotData& data, double left, double top) {
  for (const PlotOrbits& picture : data.orbits) {
    std::vector<PlotArea> areas = {{left, top - square_size, square_size, square_size}};
    double low = top - square_size, right = left + square_size;
    for (std::size_t v = 1; v < picture.views.size(); ++v) {
      const PlotView& view = picture.views[v];
      if (view.across == picture.views[0].across) {
        const double high = strip(view.high.y - view.low.y, view.high.x - view.low.x);
        low -= between_views + high;
        areas.push_back({left, low, square_size, high});
      } else {
        const double wide = strip(view.high.x - view.low.x, view.high.y - view.low.y);
        areas.push_back({right + between_views + 14, top - square_size, wide, square_size});
        right += between_views + 14 + wide;
      }
    }
    orbits_.push_back(std::move(areas));
    left = right + panel_gap;
  }
  for (PlotArea& area : boxes_) area = {left, top - box_size_, box_size_, box_size_}, left += box_size_ + panel_gap;
  for (std::size_t k = 0; k < panels_.size(); ++k) {
    if (!data.panels[k].large) continue;
    panels_[k] = {left, top - square_size, square_size, square_size};
    left += square_size + panel_gap + (data.panels[k].colors ? bar_room : 0);
  }
  return left;
}

void PlotLayout::place_grid(const PlotData& data, const PlotArea& room, std::size_t columns) {
  std::vector<std::size_t> small;
  for (std::size_t k = 0; k < panels_.size(); ++k) {
    if (!data.panels[k].large) small.push_back(k);
  }
  if (small.empty()) return;
  const std::size_t rows = (small.size() + columns - 1) / columns;
  const auto across = static_cast<double>(columns), down = static_cast<double>(rows);
  const double wide = (room.wide - (across - 1) * column_gap) / across;
  const double high = (room.high - (down - 1) * between_rows) / down;
  for (std::size_t k = 0; k < small.size(); ++k) {
    const auto column = static_cast<double>(k % columns), row = static_cast<double>(k / columns);
    panels_[small[k]] = {room.left + column * (wide + column_gap), room.low + (down - 1 - row) * (high + between_rows),
                         wide, high};
  }
}

}  // namespace noether

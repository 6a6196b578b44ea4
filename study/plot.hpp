#pragma once
/// Curves as SVG, for the report: axes, markers, names beside the curves.

#include <string>
#include <utility>
#include <vector>

namespace noether {

/// One curve. Its style (colour, marker, dashes) follows from a number, so that a method looks alike in every plot.
struct ChartCurve {
  std::string label = {};
  int style = 0;
  bool dashed = false;
  bool markers = true;
  std::vector<std::pair<double, double>> points = {};
  std::vector<bool> ringed = {};  ///< points on the front
};

struct ChartAxes {
  std::string x = {}, y = {};  ///< what stands along them, with units
  bool log_x = true;
  int width = 1000, height = 480;
};

/// The plot, as an SVG element whose colours are CSS variables of the page. Points that are not finite, or not positive
/// on a logarithmic axis, are left out.
std::string plot_svg(const ChartAxes& axes, const std::vector<ChartCurve>& curves);

}  // namespace noether

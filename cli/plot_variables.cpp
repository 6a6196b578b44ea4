/// First-order systems: their variables against time.

#include "cli/plot_source.hpp"

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

constexpr std::size_t most_variable_points = 20'000, most_variables = 8;
/// Variables have a panel of their own where they are this much smaller than the largest.
constexpr double small_gap = 100;

double size_of(const PlotCurve& curve) {
  double size = 0;
  for (const PlotPoint& p : curve.points) size = std::max(size, std::abs(p.y));
  return size;
}

}  // namespace

std::vector<PlotPanel> plot_variables(const io::Frames& frames, const PlotTime& time) {
  PlotPanel panel;
  panel.title = "Variables";
  panel.large = true;
  panel.x = time.axis;
  panel.y.label = "y";
  const std::size_t n = frames.variable_names.size(), shown = std::min(n, most_variables);
  double largest = 0;
  for (std::size_t k = 0; k < shown; ++k) {
    const std::size_t i = shown < 2 ? 0 : k * (n - 1) / (shown - 1);
    PlotCurve curve{.name = frames.variable_names[i], .points = {}, .color = k};
    for (const io::Frame& frame : frames.frames) {
      curve.points.push_back({frame.time / time.length, frame.variables[i]});
    }
    curve.points = thinned(curve.points, most_variable_points);
    largest = std::max(largest, size_of(curve));
    panel.curves.push_back(std::move(curve));
  }
  PlotPanel small = panel;
  small.title = "Small variables";
  std::erase_if(small.curves, [&](const PlotCurve& c) { return size_of(c) == 0 || size_of(c) * small_gap > largest; });
  fit_values(panel);
  if (small.curves.empty()) return {std::move(panel)};
  fit_values(small);
  return {std::move(panel), std::move(small)};
}

}  // namespace noether

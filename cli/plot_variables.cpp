/// First-order systems: their variables against time.

#include "cli/plot_source.hpp"

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

constexpr std::size_t most_variable_points = 20'000, most_variables = 8;
/// Variables have a panel of their own where they are this much smaller than the largest.
constexpr double small_gap = 100;
/// So many frames are dots too, so that a corner between two of them is seen to be none of the curve's.
constexpr std::size_t most_dots = 200;

double size_of(const PlotCurve& curve) {
  double size = 0;
  for (const PlotPoint& p : curve.points) size = std::max(size, std::abs(p.y));
  return size;
}

}  // namespace

std::vector<PlotPanel> plot_variables(const PlotFrames& frames, const PlotTime& time) {
  PlotPanel panel;
  panel.title = "Variables";
  panel.large = true;
  panel.x = time.axis;
  panel.y.label = "y";
  const std::vector<std::string>& names = frames.shared.variable_names;
  const std::size_t n = names.size(), shown = std::min(n, most_variables);
  const bool dotted = frames.size() <= most_dots;
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < shown; ++k) {
    chosen.push_back(shown < 2 ? 0 : k * (n - 1) / (shown - 1));
    panel.curves.push_back({.name = names[chosen.back()], .points = {}, .color = k, .dotted = dotted});
  }
  const std::size_t stride = (frames.size() + most_variable_points - 1) / most_variable_points;
  for (std::size_t k = 0; k < frames.size(); k += stride) {
    const io::Frame frame = frames.frame(k);
    for (std::size_t c = 0; c < shown; ++c) {
      panel.curves[c].points.push_back({frame.time / time.length, frame.variables[chosen[c]]});
    }
  }
  double largest = 0;
  for (const PlotCurve& curve : panel.curves) largest = std::max(largest, size_of(curve));
  PlotPanel small = panel;
  small.title = "Small variables";
  std::erase_if(small.curves, [&](const PlotCurve& c) { return size_of(c) == 0 || size_of(c) * small_gap > largest; });
  fit_values(panel);
  if (small.curves.empty()) return {std::move(panel)};
  fit_values(small);
  return {std::move(panel), std::move(small)};
}

}  // namespace noether

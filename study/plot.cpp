#include "study/plot.hpp"

#include "study/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

constexpr struct { int left = 74, right = 220, top = 14, bottom = 50; } margins;

class Plot {
 public:
  Plot(const ChartAxes& axes, const std::vector<ChartCurve>& curves) : axes_(axes) {
    x_.log = axes.log_x;
    for (ChartCurve curve : curves) {
      for (std::size_t k = curve.points.size(); k-- > 0;) {
        const auto [x, y] = curve.points[k];
        if (std::isfinite(x) && std::isfinite(y) && y > 0 && (x > 0 || !axes.log_x)) continue;
        curve.points.erase(curve.points.begin() + static_cast<std::ptrdiff_t>(k));
        if (k < curve.ringed.size()) curve.ringed.erase(curve.ringed.begin() + static_cast<std::ptrdiff_t>(k));
      }
      for (auto& [x, y] : curve.points) {
        y = std::min(y, 1e3);  // what has diverged stands at the upper edge
        x_.take(x);
        y_.take(y);
      }
      if (!curve.points.empty()) curves_.push_back(std::move(curve));
    }
    x_.widen();
    y_.widen();
  }

  std::string text() const {
    std::string out =
        fmt::format("<svg class=\"plot\" viewBox=\"0 0 {0} {1}\" role=\"img\" aria-label=\"{2} against {3}\">",
                    axes_.width, axes_.height, html_text(axes_.y), html_text(axes_.x));
    out += grid() + front();
    for (const ChartCurve& curve : curves_) out += drawn(curve);
    return out + labels() + "</svg>\n";
  }

 private:
  double px(double x) const { return margins.left + x_.at(x) * (axes_.width - margins.left - margins.right); }
  double py(double y) const {
    return axes_.height - margins.bottom - y_.at(y) * (axes_.height - margins.top - margins.bottom);
  }

  std::string grid() const {
    std::string out;
    const int x1 = axes_.width - margins.right, y0 = axes_.height - margins.bottom;
    for (const double x : ticks_of(x_, 10)) {
      out += fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" y1=\"{1}\" x2=\"{0:.1f}\" y2=\"{2}\"/>", px(x),
                         margins.top, y0);
      out += fmt::format("<text class=\"tick\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>", px(x), y0 + 17,
                         tick_text(x_, x));
    }
    for (const double y : ticks_of(y_, 9)) {
      out += fmt::format("<line class=\"grid\" x1=\"{0}\" y1=\"{1:.1f}\" x2=\"{2}\" y2=\"{1:.1f}\"/>", margins.left,
                         py(y), x1);
      out += fmt::format("<text class=\"tick\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", margins.left - 7,
                         py(y) + 4, tick_text(y_, y));
    }
    out += fmt::format("<path class=\"axis\" d=\"M{} {}V{}H{}\"/>", margins.left, margins.top, y0, x1);
    out += fmt::format("<text class=\"name\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                       (margins.left + x1) / 2, axes_.height - 10, html_text(axes_.x));
    const int middle = (margins.top + y0) / 2;
    return out + fmt::format(
                     "<text class=\"name\" transform=\"translate(18 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
                     middle, html_text(axes_.y));
  }

  /// The front: a staircase behind the curves.
  std::string front() const {
    std::vector<std::pair<double, double>> points;
    for (const ChartCurve& curve : curves_) {
      for (std::size_t k = 0; k < curve.ringed.size(); ++k) {
        if (curve.ringed[k]) points.push_back(curve.points[k]);
      }
    }
    if (points.size() < 2) return "";
    std::sort(points.begin(), points.end());
    std::string path = fmt::format("M{:.1f} {:.1f}", px(points[0].first), py(points[0].second));
    for (std::size_t k = 1; k < points.size(); ++k) {
      path += fmt::format("H{:.1f}V{:.1f}", px(points[k].first), py(points[k].second));
    }
    return "<path class=\"front\" d=\"" + path + "\"/>";
  }

  std::string drawn(const ChartCurve& curve) const {
    const std::string colour = style_colour(curve.style);
    std::string path;
    for (const auto& [x, y] : curve.points)
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", px(x), py(y));
    std::string out = fmt::format(
        "<g class=\"curve\" data-name=\"{}\"><path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}/>",
        html_text(curve.label), path, colour, curve.markers ? 1.6 : 1.3,
        curve.dashed ? " stroke-dasharray=\"6 3\"" : "");
    for (std::size_t k = 0; curve.markers && k < curve.points.size(); ++k) {
      const double x = px(curve.points[k].first), y = py(curve.points[k].second);
      if (k < curve.ringed.size() && curve.ringed[k]) {
        out += fmt::format("<circle class=\"ring\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"8\"/>", x, y);
      }
      out += style_mark(curve.style, curve.dashed, x, y, 4);
    }
    return out + "</g>";
  }

  /// Names in the right margin, each as near to the end of its curve as the others let it.
  std::string labels() const {
    struct Label {
      const ChartCurve* curve;
      double x, y, place;
    };
    std::vector<Label> all;
    for (const ChartCurve& curve : curves_) {
      const auto last = *std::max_element(curve.points.begin(), curve.points.end());
      all.push_back({&curve, px(last.first), py(last.second), py(last.second)});
    }
    std::stable_sort(all.begin(), all.end(), [](const Label& a, const Label& b) { return a.y < b.y; });
    const double line = std::min(17.0, (axes_.height - margins.top - 10.0) / std::max<std::size_t>(all.size(), 1));
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k].place = std::max(all[k].place, k > 0 ? all[k - 1].place + line : margins.top + 8.0);
    }
    double floor = axes_.height - 12;
    for (std::size_t k = all.size(); k-- > 0; floor -= line) all[k].place = std::min(all[k].place, floor);
    std::string out;
    const int x = axes_.width - margins.right + 14;
    for (const Label& one : all) {
      const int style = one.curve->style;
      out += fmt::format("<g class=\"label\" data-name=\"{}\">", html_text(one.curve->label));
      out += fmt::format("<path class=\"leader\" d=\"M{:.1f} {:.1f}L{} {:.1f}\" stroke=\"{}\"/>", one.x + 6, one.y,
                         x - 2, one.place, style_colour(style));
      out += style_mark(style, one.curve->dashed, x + 5, one.place, 4);
      out += fmt::format("<text class=\"series\" x=\"{}\" y=\"{:.1f}\">{}</text></g>", x + 14, one.place + 4,
                         html_text(one.curve->label));
    }
    return out;
  }

  ChartAxes axes_;
  std::vector<ChartCurve> curves_;
  AxisRange x_, y_;
};

}  // namespace

std::string plot_svg(const ChartAxes& axes, const std::vector<ChartCurve>& curves) { return Plot(axes, curves).text(); }

}  // namespace noether

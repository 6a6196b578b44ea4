#include "study/plot.hpp"

#include "engine/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace noether {

namespace {

constexpr int left = 74, right = 220, top = 14, bottom = 50;
constexpr int colours = 7;

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  bool log = true;

  void take(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  /// Some room beyond the ends: of a logarithmic axis up to the next third of a decade.
  void widen() {
    if (!(low <= high)) {
      low = log ? 1e-3 : 0;
      high = 1;
    }
    if (log) {
      low = std::pow(10, std::floor(3 * std::log10(low) - 0.3) / 3);
      high = std::pow(10, std::ceil(3 * std::log10(high) + 0.3) / 3);
    } else if (low == high) {
      high = low + 1;
    }
  }
  /// Where a value lies between the ends, 0 to 1.
  double at(double x) const { return log ? std::log(x / low) / std::log(high / low) : (x - low) / (high - low); }
};

/// 10 to a whole power, in characters.
std::string power_of_ten(int n) {
  static constexpr std::array<const char*, 10> digits = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                                         "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  if (n >= -1 && n <= 2) return fmt::format("{:g}", std::pow(10, n));
  std::string text = n < 0 ? "10\u207b" : "10";
  for (const char c : std::to_string(std::abs(n))) text += digits[static_cast<std::size_t>(c - '0')];
  return text;
}

std::vector<double> ticks_of(const Range& range, int most) {
  std::vector<double> ticks;
  if (range.log) {
    const int first = static_cast<int>(std::ceil(std::log10(range.low) - 1e-9));
    const int last = static_cast<int>(std::floor(std::log10(range.high) + 1e-9));
    const int stride = std::max(1, (last - first + most - 1) / most);
    for (int n = first; n <= last; n += stride) ticks.push_back(std::pow(10, n));
    return ticks;
  }
  const double rough = (range.high - range.low) / most, unit = std::pow(10, std::floor(std::log10(rough)));
  double stride = unit;
  for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
    stride = factor * unit;
    if (stride >= rough) break;
  }
  for (double x = std::ceil(range.low / stride) * stride; x <= range.high * (1 + 1e-12); x += stride) {
    ticks.push_back(std::abs(x) < 1e-9 * stride ? 0 : x);
  }
  return ticks;
}

std::string tick_text(const Range& range, double value) {
  return range.log ? power_of_ten(static_cast<int>(std::lround(std::log10(value)))) : fmt::format("{:g}", value);
}

/// One of seven shapes about a point.
std::string shape(int style, double x, double y, double r, const std::string& attributes) {
  const auto polygon = [&](const std::vector<std::pair<double, double>>& corners) {
    std::string points;
    for (const auto& [dx, dy] : corners) points += fmt::format("{:.1f},{:.1f} ", x + r * dx, y + r * dy);
    return fmt::format("<polygon points=\"{}\" {}/>", points, attributes);
  };
  switch (style % 5) {
    case 0:
      return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" {}/>", x, y, r, attributes);
    case 1:
      return polygon({{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}});
    case 2:
      return polygon({{0, -1.2}, {1.1, 0.8}, {-1.1, 0.8}});
    case 3:
      return polygon({{0, -1.3}, {1.3, 0}, {0, 1.3}, {-1.3, 0}});
    default:
      return polygon({{0, 1.2}, {1.1, -0.8}, {-1.1, -0.8}});
  }
}

std::string marker(int style, bool hollow, double x, double y, double r) {
  const std::string colour = fmt::format("var(--c{})", style % colours);
  return shape(style, x, y, r,
               fmt::format("fill=\"{}\" stroke=\"{}\" stroke-width=\"1.4\"", hollow ? "var(--page)" : colour, colour));
}

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
  double px(double x) const { return left + x_.at(x) * (axes_.width - left - right); }
  double py(double y) const { return axes_.height - bottom - y_.at(y) * (axes_.height - top - bottom); }

  std::string grid() const {
    std::string out;
    const int x1 = axes_.width - right, y0 = axes_.height - bottom;
    for (const double x : ticks_of(x_, 10)) {
      out += fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" y1=\"{1}\" x2=\"{0:.1f}\" y2=\"{2}\"/>", px(x), top, y0);
      out += fmt::format("<text class=\"tick\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>", px(x), y0 + 17,
                         tick_text(x_, x));
    }
    for (const double y : ticks_of(y_, 9)) {
      out += fmt::format("<line class=\"grid\" x1=\"{0}\" y1=\"{1:.1f}\" x2=\"{2}\" y2=\"{1:.1f}\"/>", left, py(y), x1);
      out += fmt::format("<text class=\"tick\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", left - 7,
                         py(y) + 4, tick_text(y_, y));
    }
    out += fmt::format("<path class=\"axis\" d=\"M{} {}V{}H{}\"/>", left, top, y0, x1);
    out += fmt::format("<text class=\"name\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>", (left + x1) / 2,
                       axes_.height - 10, html_text(axes_.x));
    const int middle = (top + y0) / 2;
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
    const std::string colour = fmt::format("var(--c{})", curve.style % colours);
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
      out += marker(curve.style, curve.dashed, x, y, 4);
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
    const double line = std::min(17.0, (axes_.height - top - 10.0) / std::max<std::size_t>(all.size(), 1));
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k].place = std::max(all[k].place, k > 0 ? all[k - 1].place + line : top + 8.0);
    }
    double floor = axes_.height - 12;
    for (std::size_t k = all.size(); k-- > 0; floor -= line) all[k].place = std::min(all[k].place, floor);
    std::string out;
    const int x = axes_.width - right + 14;
    for (const Label& one : all) {
      const int style = one.curve->style;
      out += fmt::format("<g class=\"label\" data-name=\"{}\">", html_text(one.curve->label));
      out += fmt::format("<path class=\"leader\" d=\"M{:.1f} {:.1f}L{} {:.1f}\" stroke=\"var(--c{})\"/>", one.x + 6,
                         one.y, x - 2, one.place, style % colours);
      out += marker(style, one.curve->dashed, x + 5, one.place, 4);
      out += fmt::format("<text class=\"series\" x=\"{}\" y=\"{:.1f}\">{}</text></g>", x + 14, one.place + 4,
                         html_text(one.curve->label));
    }
    return out;
  }

  ChartAxes axes_;
  std::vector<ChartCurve> curves_;
  Range x_, y_;
};

}  // namespace

std::string plot_svg(const ChartAxes& axes, const std::vector<ChartCurve>& curves) { return Plot(axes, curves).text(); }

std::string marker_svg(int style, bool hollow) {
  return "<svg class=\"swatch\" viewBox=\"0 0 14 14\">" + marker(style, hollow, 7, 7, 4) + "</svg>";
}

std::string html_text(std::string_view text) {
  std::string out;
  for (const char c : plain_line(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

}  // namespace noether

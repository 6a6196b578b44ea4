#include "study/svg.hpp"

#include "numbers/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace noether {

namespace {

/// 10 to a whole power, in characters.
std::string power_of_ten(int n) {
  static constexpr std::array<const char*, 10> digits = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                                         "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  if (n >= -1 && n <= 2) return fmt::format("{:g}", std::pow(10, n));
  std::string text = n < 0 ? "10\u207b" : "10";
  for (const char c : std::to_string(std::abs(n))) text += digits[static_cast<std::size_t>(c - '0')];
  return text;
}

/// One of five shapes about a point.
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

}  // namespace

void AxisRange::take(double x) {
  low = std::min(low, x);
  high = std::max(high, x);
}

void AxisRange::widen() {
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

double AxisRange::at(double x) const {
  return log ? std::log(x / low) / std::log(high / low) : (x - low) / (high - low);
}

std::vector<double> ticks_of(const AxisRange& range, int most) {
  std::vector<double> ticks;
  if (range.log) {
    const int first = static_cast<int>(std::ceil(std::log10(range.low) - 1e-9));
    const int last = static_cast<int>(std::floor(std::log10(range.high) + 1e-9));
    if (last - first <= 2) {
      for (int n = first - 1; n <= last; ++n) {
        for (const int digit : {1, 2, 5}) {
          const double x = digit * std::pow(10, n);
          if (x >= range.low * (1 - 1e-9) && x <= range.high * (1 + 1e-9)) ticks.push_back(x);
        }
      }
      return ticks;
    }
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

std::string tick_text(const AxisRange& range, double value) {
  const double power = std::log10(value);
  if (!range.log || std::abs(power - std::round(power)) > 1e-9) return fmt::format("{:.6g}", value);
  return power_of_ten(static_cast<int>(std::lround(power)));
}

std::string style_colour(int style) { return fmt::format("var(--c{})", style % 7); }

std::string style_mark(int style, bool hollow, double x, double y, double r) {
  const std::string colour = style_colour(style);
  return shape(style, x, y, r,
               fmt::format("fill=\"{}\" stroke=\"{}\" stroke-width=\"1.4\"", hollow ? "var(--page)" : colour, colour));
}

std::string marker_svg(int style, bool hollow) {
  return "<svg class=\"swatch\" viewBox=\"0 0 14 14\">" + style_mark(style, hollow, 7, 7, 4) + "</svg>";
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

#pragma once
/// What plots as SVG are made of: axes with ticks, marks, texts. Colours are CSS variables of the page.

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// A text with the characters of markup replaced: nothing in it can end an element.
std::string html_text(std::string_view text);

/// What an axis spans.
struct AxisRange {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  bool log = true;

  void take(double x);
  /// Some room beyond the ends: of a logarithmic axis up to the next third of a decade.
  void widen();
  /// Where a value lies between the ends, 0 to 1.
  double at(double x) const;
};

/// Round values along an axis: powers of ten on a logarithmic one, between few of them also 2 and 5 times those.
std::vector<double> ticks_of(const AxisRange& range, int most);
std::string tick_text(const AxisRange& range, double value);

/// Of a style, counted from 0: one of seven colours, and one of five marks about a point.
std::string style_colour(int style);
std::string style_mark(int style, bool hollow, double x, double y, double r);

/// The mark of a style, as an SVG element of its own for tables.
std::string marker_svg(int style, bool hollow);

}  // namespace noether

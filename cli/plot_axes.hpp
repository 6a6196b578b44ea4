#pragma once
/// Axes of pictures: time in a unit that people read, and ranges that hold what is drawn.

#include "cli/plot_data.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// "time (yr)"; without brackets where there is no unit.
std::string with_unit(const std::string& text, const std::string& unit);

/// The time axis that all panels of a run share.
struct PlotTime {
  std::string unit;   ///< its name
  double length = 1;  ///< of the unit, in the unit of the file
  PlotAxis axis;      ///< from the first to the last moment, in the unit
};

/// A unit in which people read a length.
struct PlotLength {
  std::string unit;   ///< its name
  double length = 1;  ///< of the unit, in the unit of the file
};

/// The unit of orbits of a size: kilometers instead of astronomical units about a planet.
PlotLength readable_length(const std::string& unit, double size);

/// Marks of an axis, and what their numbers leave to its name: a power of ten, and a round number that is taken off
/// where they would be long and differ little.
struct PlotMarks {
  std::vector<std::pair<double, std::string>> marks;
  int power = 0;
  double offset = 0;
};

/// Marks of a linear axis, about `most`. @param power  of ten; nothing: one that makes numbers short
PlotMarks marks_of(double low, double high, double most, std::optional<int> power = {});
/// Marks at 1, 2 and 5 times the powers of ten of a short logarithmic axis.
PlotMarks decade_marks_of(double low, double high);

/// "y (10^-5 m)" with the power in small figures; the label as it is for the power 0.
std::string with_power(const std::string& label, int power);
/// What the axis is called: "y - 9999990 (m)" beside marks that have an offset, with their power as `with_power`.
std::string axis_name(const std::string& label, const PlotMarks& marks);

/// Whether moments are spaced so that each is a multiple of the one before, as far as more of them fit on a logarithmic
/// axis than on a linear one: two decades at least, and half of them in the first tenth. A first moment 0 is left out.
bool is_spaced_by_ratios(const std::vector<double>& times);

/// The time axis of moments in a unit of the file, such as "day". @param frames  those that choose its kind
PlotTime time_axis(const std::string& unit, const std::vector<double>& frames, double begin, double end);

/// A moment in the axis' unit, "6712.3 yr", with digits that tell it from others of the axis. @param t  in the file's
/// unit
std::string told_time(const PlotTime& time, double t);

/// Makes the axis of the values hold all curves, with some air: logarithmic where it must be.
void fit_values(PlotPanel& panel);

/// The same of sizes of errors: logarithmic where they span a decade, few decades below the largest.
void fit_errors(PlotPanel& panel);

/// At most `most` points, at equal distances, the first among them.
template <class Point> std::vector<Point> thinned(const std::vector<Point>& points, std::size_t most) {
  const std::size_t stride = points.size() <= most ? 1 : (points.size() + most - 1) / most;
  std::vector<Point> kept;
  for (std::size_t k = 0; k < points.size(); k += stride) kept.push_back(points[k]);
  return kept;
}

}  // namespace noether

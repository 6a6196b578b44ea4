#pragma once
/// What a plot of a run shows: orbits and errors, as plain numbers.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace noether {

class Parts;

struct PlotPoint {
  double x = 0, y = 0;
};

/// One body in the plane of x and y, or of time and x where all move along one line; or a variable against time.
struct PlotOrbit {
  std::string name;
  std::size_t color = 0;                ///< number in the palette
  bool primary = false;                 ///< stands in the center
  std::vector<PlotPoint> path = {};     ///< joined by a line
  std::vector<PlotPoint> samples = {};  ///< where it was seen, single points
  PlotPoint end = {};                   ///< at the last frame
  double extent = 0;                    ///< largest distance from the center of the picture, or size of a variable
};

/// Orbits that share one scale.
struct PlotOrbits {
  std::string title, x_label, y_label;
  std::vector<PlotOrbit> orbits;
  PlotPoint low = {-1, -1}, high = {1, 1};  ///< corners of the picture
};

struct PlotCurve {
  std::string name;               ///< empty where it is alone in its panel
  std::vector<PlotPoint> points;  ///< zeros left out: the axis is logarithmic
};

/// The size of an error against time, or of several that belong together.
struct PlotError {
  std::string title, label;
  std::vector<PlotCurve> curves;
  double worst = 0;  ///< of the last curve
};

struct PlotData {
  std::string title, subtitle, time_label;
  std::vector<PlotOrbits> orbits;  ///< one, or two where the small need a scale of their own
  std::vector<PlotError> errors;
  double begin = 0, end = 0;  ///< of the time axis
};

/// Gathers what a trajectory file holds. @param parts  those that its scene may name
/// @throws FileError if it cannot be read; Error if there is nothing in it to draw
PlotData read_plot_data(const std::filesystem::path& file, const Parts& parts);

}  // namespace noether

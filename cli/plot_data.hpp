#pragma once
/// What a picture of a run shows, as plain numbers: paths in space, particles in their box, and curves.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {

class Parts;

struct PlotPoint {
  double x = 0, y = 0;
};

/// A point in space.
using PlotPlace = std::array<double, 3>;

/// The color of a curve that the panel chooses by its place in it.
inline constexpr std::size_t automatic_color = std::numeric_limits<std::size_t>::max();
/// The color of the body in the center.
inline constexpr std::size_t primary_color = automatic_color - 1;

/// The way of one body.
struct PlotOrbit {
  std::string name;
  std::size_t color = 0;                ///< number in the palette
  bool primary = false;                 ///< stands in the center
  std::vector<PlotPlace> path = {};     ///< joined by a line
  std::vector<PlotPlace> samples = {};  ///< where it was seen, single points
  PlotPlace end = {};                   ///< at the frame that is shown
  double extent = 0;                    ///< largest distance from the center of the picture
};

/// Two axes onto which paths are projected.
struct PlotView {
  std::size_t across = 0, up = 1;
  std::string across_label, up_label;
  PlotPoint low = {-1, -1}, high = {1, 1};  ///< corners of the picture
};

/// Lines between bodies that are held together, at one moment.
struct PlotLinks {
  std::vector<std::pair<PlotPlace, PlotPlace>> lines;
  double age = 0;  ///< 0 at the frame that is shown, 1 long before
};

/// Paths that share one scale, seen from one to three sides: the first view is the large one.
struct PlotOrbits {
  std::string title;
  std::vector<PlotOrbit> orbits;
  std::vector<PlotLinks> links = {};  ///< the oldest first
  std::vector<PlotView> views = {};
  double size_of_bodies = 1;  ///< beside that of few
  bool links_alone = false;   ///< links stand for paths, and bodies have one color
};

/// A particle as it is seen: farther ones come first.
struct PlotDisc {
  double x = 0, y = 0, radius = 0;
  double depth = 0;  ///< 0 in front, 1 at the back
  std::size_t color = 0;
};

/// Half a bond, from its particle to the middle.
struct PlotStick {
  PlotPoint from, to;
  double depth = 0;
  std::size_t color = 0;
};

/// Particles in their box, or many in open space, in perspective.
struct PlotBox {
  std::string title;
  std::vector<PlotDisc> discs;    ///< from back to front
  std::vector<PlotStick> sticks;  ///< from back to front
  std::vector<std::pair<PlotPoint, PlotPoint>> far_edges, near_edges;
  PlotPoint low = {-1, -1}, high = {1, 1};  ///< corners of the picture
};

struct PlotCurve {
  std::string name;  ///< empty where the panel's key does not have it
  std::vector<PlotPoint> points;
  std::size_t color = automatic_color;
  bool separate = false;  ///< points that are not joined
  bool dotted = false;    ///< points are dots on the line
};

struct PlotAxis {
  std::string label;
  double low = 0, high = 1;
  bool logarithmic = false;
};

/// Colors that tell a third number of the points of a panel's only curve.
struct PlotColors {
  std::vector<double> values;  ///< of each point; NaN where there is none
  PlotAxis scale = {};         ///< beyond its ends colors are those of the ends
  bool cells = false;          ///< points are those of a grid with equal distances, and are drawn as its cells
};

/// Curves over one axis: errors, elements, temperature, g(r), variables.
struct PlotPanel {
  std::string title;
  PlotAxis x, y;
  std::vector<PlotCurve> curves;
  bool large = false;         ///< stands where orbits would
  bool points_alone = false;  ///< of a large one: no line joins them
  std::optional<PlotColors> colors = {};
};

/// A line of the legend: a color and what has it.
struct PlotLegend {
  std::string name;
  std::size_t color = 0;
};

struct PlotData {
  std::string title, subtitle;
  std::vector<PlotOrbits> orbits;  ///< one, or two where the small need a scale of their own
  std::vector<PlotBox> boxes;      ///< one, or none
  std::vector<PlotPanel> panels;
  std::vector<PlotLegend> legend;  ///< empty where there are too many bodies to tell
};

/// What a user asks of a picture.
struct PlotOptions {
  std::optional<std::int64_t> frame = {};  ///< which one is shown, from 0; -1, as nothing, is the last
  std::vector<std::string> what = {};      ///< of `plot_subjects`; empty: what fits the run
  std::string projection = {};             ///< "xy", "xz", "yz" or "all"; empty: what shows the motion
};

/// What can be drawn, in the order of the page.
const std::vector<std::string>& plot_subjects();

/// Gathers what a trajectory file holds. @param parts  those that its scene may name
/// @throws FileError if it cannot be read; Error if there is nothing in it to draw, or not what was asked for
PlotData read_plot_data(const std::filesystem::path& file, const Parts& parts, const PlotOptions& options = {});

}  // namespace noether

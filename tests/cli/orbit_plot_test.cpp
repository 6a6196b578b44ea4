// What a picture of orbits is made of: which sides are seen, logarithmic time, elements, legends.

#include "cli/plot_layout.hpp"
#include "cli/plot_script.hpp"
#include "cli/plot_source.hpp"
#include "tests/cli/support.hpp"

#include <cmath>
#include <string>
#include <vector>

#if NOETHER_HDF5

namespace noether::test {
namespace {

/// A primary of mass 1, and bodies of no mass on circles of radius 1, 2, ..., inclined by an angle, G = 1.
io::Frames circles(std::size_t bodies, double inclination, std::size_t count, double spacing) {
  io::Frames frames;
  frames.length_unit = "au";
  frames.masses.assign(bodies + 1, 0.0);
  frames.masses[0] = 1;
  frames.names = {"Sun"};
  for (std::size_t i = 1; i <= bodies; ++i) frames.names.push_back("b" + std::to_string(i));
  for (std::size_t k = 0; k < count; ++k) {
    io::Frame frame;
    frame.time = spacing * static_cast<double>(k);
    frame.positions = frame.velocities = {0, 0, 0};
    for (std::size_t i = 1; i <= bodies; ++i) {
      const auto r = static_cast<double>(i);
      const double rate = 1 / std::sqrt(r * r * r), angle = rate * frame.time;
      for (const double x :
           {std::cos(angle), std::sin(angle) * std::cos(inclination), std::sin(angle) * std::sin(inclination)}) {
        frame.positions.push_back(r * x);
      }
      for (const double v :
           {-std::sin(angle), std::cos(angle) * std::cos(inclination), std::cos(angle) * std::sin(inclination)}) {
        frame.velocities.push_back(r * rate * v);
      }
    }
    frames.frames.push_back(std::move(frame));
  }
  return frames;
}

TEST_CASE("time is logarithmic where frames are spaced by ratios, from 0 too", "[cli][plot]") {
  std::vector<double> ratios = {0}, equal;
  for (int k = 0; k < 40; ++k) ratios.push_back(1e-4 * std::pow(2.0, k)), equal.push_back(0.1 * k);
  CHECK(is_spaced_by_ratios(ratios));
  CHECK_FALSE(is_spaced_by_ratios(equal));
  CHECK_FALSE(is_spaced_by_ratios({1, 2, 4, 8, 16, 32}));      // less than two decades
  CHECK_FALSE(is_spaced_by_ratios({0, 1e-9, 1, 2, 3, 4, 5}));  // a leap
  std::vector<double> backward = ratios;
  for (double& t : backward) t = -t;
  CHECK_FALSE(is_spaced_by_ratios(backward));
  CHECK(is_spaced_by_ratios({0, 1, 3, 10, 30, 100, 300, 1000}));
  const PlotTime time = time_axis("1", ratios, 0, ratios.back());
  CHECK(time.axis.logarithmic);
  CHECK(time.axis.low == 1e-4);
  CHECK(time_axis("day", equal, 0, 3652.5).axis.high == 10);  // years
}

TEST_CASE("orbits are seen from the side where they are inclined, and are circles in a true scale", "[cli][plot]") {
  const auto flat = plot_orbits(circles(1, 0, 200, 0.05), 199, 1.0, "");
  REQUIRE(flat.size() == 1);
  CHECK(flat[0].views.size() == 1);
  const auto inclined = plot_orbits(circles(1, 0.5, 200, 0.05), 199, 1.0, "");
  REQUIRE(inclined[0].views.size() == 2);
  CHECK(inclined[0].views[1].up == 2);
  CHECK(inclined[0].views[1].up_label == "z (au)");
  REQUIRE(inclined[0].orbits.size() == 2);
  const PlotOrbit& orbit = inclined[0].orbits[1];
  CHECK(orbit.path.size() > 1000);  // dense frames are joined
  for (const PlotPlace& p : orbit.path) CHECK(std::abs(std::hypot(p[0], p[1], p[2]) - 1) < 1e-6);

  PlotData data;
  data.orbits = inclined;
  const PlotLayout layout(data);
  const PlotView &top = inclined[0].views[0], &side = inclined[0].views[1];
  const double scale = layout.orbits(0, 0).wide / (top.high.x - top.low.x);
  CHECK(std::abs(layout.orbits(0, 1).high / (side.high.y - side.low.y) - scale) < 1e-9 * scale);
  CHECK(plot_orbits(circles(1, 0.5, 200, 0.05), 0, 1.0, "all")[0].views.size() == 3);
  CHECK(plot_orbits(circles(1, 0.5, 200, 0.05), 0, 1.0, "yz")[0].views[0].across == 1);
}

TEST_CASE("no view is wider or higher than the first where bodies move along z", "[cli][plot]") {
  for (const std::string projection : {"", "all"}) {
    io::Frames frames = circles(1, 0.5, 200, 0.05);
    for (io::Frame& frame : frames.frames) {
      frame.positions[5] *= 1000, frame.velocities[5] *= 1000;
    }
    PlotData data;
    data.orbits = plot_orbits(frames, 199, 1.0, projection);
    for (const PlotView& view : data.orbits[0].views) {
      CHECK(view.high.x <= data.orbits[0].views[0].high.x);
      CHECK(view.high.y <= data.orbits[0].views[0].high.y);
    }
    CHECK(PlotLayout(data).height() < 1500);
  }
}

TEST_CASE("the path of a particle goes on where it leaves its periodic box", "[cli][plot]") {
  io::Frames frames = circles(1, 0, 30, 0.1);
  frames.masses = {1, 1};
  for (io::Frame& frame : frames.frames) {
    frame.edges = {2, 2, 2};
    const double x = 1.5 * frame.time;
    const auto crossed = static_cast<std::int32_t>(std::floor(x / 2));
    frame.images = {0, 0, 0, crossed, 0, 0};
    frame.positions = {1, 0, 0, x - 2 * crossed, 0, 0};
    frame.velocities = {0, 0, 0, 1.5, 0, 0};
  }
  const auto line = plot_line_positions(frames, time_axis("1", {}, 0, 2.9));
  REQUIRE(line);
  for (const PlotPoint& p : line->curves[1].points) CHECK(std::abs(p.y - 1.5 * p.x) < 1e-9);
  const auto pictures = plot_orbits(frames, 29, {}, "xy");
  for (std::size_t k = 1; k < pictures[0].orbits[1].path.size(); ++k) {
    CHECK(pictures[0].orbits[1].path[k][0] >= pictures[0].orbits[1].path[k - 1][0]);
  }
}

TEST_CASE("an orbit seen seldom is drawn as the ellipse of its elements", "[cli][plot]") {
  const auto seldom = plot_orbits(circles(1, 0.3, 30, 10), 29, 1.0, "");
  const PlotOrbit& orbit = seldom[0].orbits[1];
  CHECK(orbit.samples.size() == 30);
  REQUIRE(orbit.path.size() == 361);
  for (const PlotPlace& p : orbit.path) {
    CHECK(std::abs(std::hypot(p[0], p[1], p[2]) - 1) < 1e-9);
    CHECK(std::abs(p[2] * std::cos(0.3) - p[1] * std::sin(0.3)) < 1e-9);
  }
}

TEST_CASE("elements against time are those of the frames", "[cli][plot]") {
  PlotSource source{.file = {},
                    .scene = {},
                    .frames = circles(2, 0.5, 30, 1),
                    .monitors = {},
                    .time = time_axis("day", {}, 0, 29),
                    .shown = 0,
                    .G = 1.0};
  const auto panels = plot_elements(source);
  REQUIRE(panels.size() == 3);
  REQUIRE(panels[0].curves.size() == 2);
  for (const PlotPoint& p : panels[0].curves[1].points) CHECK(std::abs(p.y - 2) < 1e-12);
  for (const PlotPoint& p : panels[1].curves[0].points) CHECK(p.y < 1e-12);
  for (const PlotPoint& p : panels[2].curves[0].points) CHECK(std::abs(p.y - 0.5 * 180 / M_PI) < 1e-10);
  source.frames = circles(2, 0, 30, 1);
  CHECK(plot_elements(source).size() == 2);  // no inclination in the plane of x and y
}

TEST_CASE("the legend has the bodies, or nothing where there are too many", "[cli][plot]") {
  CHECK(body_legend(circles(1, 0, 1, 1)).size() == 2);
  CHECK(body_legend(circles(12, 0, 1, 1)).size() == 13);
  CHECK(body_legend(circles(13, 0, 1, 1)).empty());
  CHECK(is_crowd(circles(200, 0, 1, 1)));
  CHECK_FALSE(is_crowd(circles(101, 0, 1, 1)));
}

TEST_CASE("one frame, two bodies in one place and backward time are drawn", "[cli][plot]") {
  io::Frames one = circles(2, 0, 1, 1);
  for (std::size_t k = 0; k < 3; ++k) one.frames[0].positions[6 + k] = one.frames[0].positions[3 + k];
  for (std::size_t k = 0; k < 3; ++k) one.frames[0].positions[3 + k] = 0;  // on the primary
  const auto pictures = plot_orbits(one, 0, 1.0, "");
  REQUIRE(pictures.size() == 1);
  CHECK(pictures[0].orbits[1].path.empty());
  CHECK(std::isfinite(pictures[0].views[0].high.x));
  const auto backward = plot_orbits(circles(1, 0, 200, -0.05), 199, 1.0, "");
  for (const PlotPlace& p : backward[0].orbits[1].path) CHECK(std::abs(std::hypot(p[0], p[1], p[2]) - 1) < 1e-6);
  CHECK(time_axis("1", {0, -1, -2}, -2, 0).axis.low == -2);
}

TEST_CASE("errors have a logarithmic axis where they span decades, a linear one elsewhere", "[cli][plot]") {
  PlotPanel panel;
  panel.curves.push_back({.name = "", .points = {{0, 1e-12}, {1, 3e-10}}});
  fit_errors(panel);
  CHECK(panel.y.logarithmic);
  CHECK((panel.y.low <= 1e-12 && panel.y.high >= 3e-10));
  panel.curves[0].points = {{0, 0.1}, {1, 0.3}};
  fit_errors(panel);
  CHECK_FALSE(panel.y.logarithmic);
  CHECK(panel.y.low == 0);
  panel.curves[0].points.clear();
  fit_errors(panel);
  CHECK(panel.y.low > 0);
}

}  // namespace
}  // namespace noether::test

#endif

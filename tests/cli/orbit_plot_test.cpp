// What a picture of orbits is made of: which sides are seen, logarithmic time, elements, legends.

#include "cli/plot_layout.hpp"
#include "cli/plot_script.hpp"
#include "cli/plot_source.hpp"
#include "scene/parts.hpp"
#include "tests/cli/support.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
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

TEST_CASE("an orbit seen often in too many frames to join them all is a line through the last ones", "[cli][plot]") {
  const std::size_t count = 60'001;  // of which each fourth is kept: 6 a turn
  const double spacing = 2 * M_PI / 25;
  for (const std::size_t shown : {count - 1, std::size_t{0}}) {
    const auto pictures = plot_orbits(circles(1, 0, count, spacing), shown, {}, "xy");
    const PlotOrbit& orbit = pictures[0].orbits[1];
    CHECK(orbit.path.size() > 1000);
    CHECK(orbit.samples.size() > 500);  // all of the run
    for (const PlotPlace& p : orbit.path) CHECK(std::abs(std::hypot(p[0], p[1]) - 1) < 1e-4);
  }
  // 2.5 frames a turn are not joined, however many there are.
  CHECK(plot_orbits(circles(1, 0, count, 10 * spacing), count - 1, {}, "xy")[0].orbits[1].path.empty());
}

TEST_CASE("the picture of inner orbits has the links of inner bodies", "[cli][plot]") {
  io::Frames frames = circles(5, 0, 3, 0.01);
  for (io::Frame& frame : frames.frames) {
    for (std::size_t k = 12; k < 18; ++k) frame.positions[k] *= 20;
  }
  ParticleLinks links;
  links.pairs = {{1, 2}, {2, 4}, {4, 5}};
  const auto pictures = plot_orbits(frames, 2, 1.0, "xy", links);
  REQUIRE(pictures.size() == 2);
  CHECK(pictures[0].links.at(0).lines.size() == 3);
  REQUIRE(pictures[1].links.size() == 1);
  REQUIRE(pictures[1].links[0].lines.size() == 1);
  CHECK(pictures[1].links[0].lines[0].first == pictures[1].orbits[1].end);
}

TEST_CASE("bodies that are called by colors are drawn in them", "[cli][plot]") {
  io::Frames frames = circles(2, 0, 3, 1);
  frames.masses = {1, 1, 1};
  frames.names = {"red", "Green", "blue"};
  const auto legend = body_legend(frames);
  const auto drawn = plot_orbits(frames, 2, {}, "xy");
  PlotData data;
  data.orbits = drawn;
  const std::string script = plot_script(data, PictureFormat::svg, "picture");
  for (const auto& [body, color] : {std::pair(0, "#CC3311"), std::pair(1, "#228833"), std::pair(2, "#0077BB")}) {
    CAPTURE(body);
    CHECK(legend.at(static_cast<std::size_t>(body)).color == drawn[0].orbits[static_cast<std::size_t>(body)].color);
    const std::size_t end = script.find("$o0_" + std::to_string(body) + "e using");
    REQUIRE(end != std::string::npos);
    CHECK(script.substr(end, 80).find(color) != std::string::npos);
  }
  frames.names[2] = "Sirius";  // one that is not a color: all have those of the palette, each its own
  CHECK(body_color(frames, 0) == 0);
  CHECK(body_color(frames, 1) == 1);
  CHECK(body_color(frames, 2) == 2);
}

/// A chain of `n` bodies along x, one apart, that moves up by 1 with each frame.
io::Frames rising_chain(std::size_t n, std::size_t count) {
  io::Frames frames;
  frames.length_unit = "m";
  frames.masses.assign(n, 1);
  for (std::size_t i = 0; i < n; ++i) frames.names.push_back(std::to_string(i));
  for (std::size_t k = 0; k < count; ++k) {
    io::Frame frame;
    frame.time = static_cast<double>(k);
    for (std::size_t i = 0; i < n; ++i) {
      frame.positions.insert(frame.positions.end(), {static_cast<double>(i), static_cast<double>(k), 0});
      frame.velocities.insert(frame.velocities.end(), {0, 1, 0});
    }
    frames.frames.push_back(std::move(frame));
  }
  return frames;
}

TEST_CASE("of many linked bodies the links are drawn, at the frame that is shown and before, instead of paths",
          "[cli][plot]") {
  ParticleLinks links;
  for (std::size_t i = 0; i < 39; ++i) links.pairs.emplace_back(i, i + 1);
  links.anchors.push_back({0, {0, 0, 0}});
  const auto many = plot_orbits(rising_chain(40, 57), 56, {}, "xy", links);
  REQUIRE(many.size() == 1);
  CHECK(many[0].links_alone);
  for (const PlotOrbit& orbit : many[0].orbits) CHECK((orbit.path.empty() && orbit.samples.empty()));
  REQUIRE(many[0].links.size() == 15);
  CHECK(many[0].links.front().age == 1);
  CHECK(many[0].links.front().lines[0].first[1] == 0);  // at the start
  CHECK(many[0].links.back().age == 0);
  for (const PlotLinks& moment : many[0].links) REQUIRE(moment.lines.size() == 40);
  CHECK(many[0].links.back().lines[3] == std::pair(PlotPlace{3, 56, 0}, PlotPlace{4, 56, 0}));
  CHECK(many[0].links.back().lines[39] == std::pair(PlotPlace{0, 0, 0}, PlotPlace{0, 56, 0}));

  links.pairs = {{0, 1}};
  const auto few = plot_orbits(rising_chain(2, 57), 56, {}, "xy", links);
  CHECK_FALSE(few[0].links_alone);
  CHECK_FALSE(few[0].orbits[0].path.empty());
  REQUIRE(few[0].links.size() == 1);  // at the frame that is shown alone
  CHECK(few[0].links[0].lines.size() == 2);
  CHECK(few[0].views[0].low.y <= 0);  // where the rod hangs is seen too
}

TEST_CASE("plot draws what a scene's constraints and a structure's bonds hold together", "[cli][plot]") {
  const SceneFolder folder(
      "units = \"si\"\n[particles]\nbody = [{ name = \"a\", mass = \"1 kg\", x = [\"1 m\", \"0 m\", \"0 m\"], v = [\"0 "
      "m/s\", "
      "\"0 m/s\", \"0 m/s\"] }, { name = \"b\", mass = \"1 kg\", x = [\"2 m\", \"0 m\", \"0 m\"], v = [\"0 m/s\", \"0 "
      "m/s\", \"0 "
      "m/s\"] }]\n[hamiltonian]\ntype = \"kinetic_potential\"\n[[hamiltonian.force]]\ntype = "
      "\"uniform_field\"\nacceleration = "
      "[\"0 m/s^2\", \"-9.8 m/s^2\", \"0 m/s^2\"]\n[[hamiltonian.constraint]]\ntype = \"on_sphere\"\nbodies = "
      "[\"a\"]\nradius = "
      "\"1 m\"\n[[hamiltonian.constraint]]\ntype = \"distance\"\npairs = [[\"a\", \"b\"]]\n[integrator]\nmethod = "
      "\"verlet\"\nstep = \"0.01 s\"\nsteps = 50\n[[every]]\ntype = \"trajectory\"\nsteps = 1\n");
  output(folder, "run scene.toml --quiet");
  const PlotData data = read_plot_data(folder / "scene.out/run.h5", standard_parts());
  REQUIRE(data.orbits.size() == 1);
  REQUIRE(data.orbits[0].links.size() == 1);
  const auto& lines = data.orbits[0].links[0].lines;
  REQUIRE(lines.size() == 2);
  const auto length = [](const auto& line) {
    const auto& [a, b] = line;
    return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
  };
  CHECK(std::abs(length(lines[0]) - 1) < 1e-9);
  CHECK(std::abs(length(lines[1]) - 1) < 1e-9);
  CHECK(lines[0].second == data.orbits[0].orbits[1].end);
  CHECK(lines[1].first == PlotPlace{0, 0, 0});
}

/// Bodies p0, p1, ... one meter apart along x, at rest, with lines of a scene after them.
std::string row_of_bodies(std::size_t n, const std::string& rest) {
  std::string scene = "units = \"si\"\n";
  for (std::size_t i = 0; i < n; ++i) {
    scene += "[[particles.body]]\nname = \"p" + std::to_string(i) + "\"\nmass = \"1 kg\"\nx = [\"" +
             std::to_string(i + 1) + " m\", \"0 m\", \"0 m\"]\nv = [\"0 m/s\", \"0 m/s\", \"0 m/s\"]\n";
  }
  return scene + "[hamiltonian]\ntype = \"kinetic_potential\"\n[[hamiltonian.force]]\ntype = \"uniform_field\"\n" +
         "acceleration = [\"0 m/s^2\", \"-9.8 m/s^2\", \"0 m/s^2\"]\n[[hamiltonian.constraint]]\n" + rest +
         "[integrator]\nmethod = \"verlet\"\nstep = \"0.01 s\"\nsteps = 50\n[[every]]\ntype = "
         "\"trajectory\"\nsteps = 1\n";
}

TEST_CASE("all bodies at the ends of rods hang at their point, unless they are many", "[cli][plot]") {
  for (const std::size_t n : {std::size_t{2}, std::size_t{4}}) {
    const SceneFolder folder(row_of_bodies(n, "type = \"on_sphere\"\nbodies = \"all\"\n"));
    output(folder, "run scene.toml --quiet");
    const PlotData data = read_plot_data(folder / "scene.out/run.h5", standard_parts());
    REQUIRE(data.orbits.size() == 1);
    if (n == 4) {
      CHECK(data.orbits[0].links.empty());
      continue;
    }
    REQUIRE(data.orbits[0].links.size() == 1);
    REQUIRE(data.orbits[0].links[0].lines.size() == 2);
    for (const auto& [point, end] : data.orbits[0].links[0].lines) CHECK(point == PlotPlace{0, 0, 0});
  }
}

TEST_CASE("a chain's picture says when its links are shown", "[cli][plot]") {
  const SceneFolder folder(row_of_bodies(14, "type = \"distance\"\nchain = [\"p0\", \"p13\"]\n"));
  output(folder, "run scene.toml --quiet");
  const PlotData data = read_plot_data(folder / "scene.out/run.h5", standard_parts());
  REQUIRE(data.orbits.size() == 1);
  CHECK(data.orbits[0].title == "At t = 0.5 s, and 14 moments before");
  CHECK(data.legend.empty());
}

TEST_CASE("orbits about a planet are in kilometers, those about a star in astronomical units", "[cli][plot]") {
  CHECK(readable_length("au", 0.0099).unit == "km");
  CHECK(readable_length("au", 0.0101).unit == "au");
  CHECK(readable_length("nm", 0.001).unit == "nm");
  const PlotLength km = readable_length("au", 0.001);
  CHECK(std::abs(0.001 / km.length - 149'597.870'7) < 1e-6);
  io::Frames frames = circles(1, 0, 200, 0.05);
  for (io::Frame& frame : frames.frames) {
    for (double& x : frame.positions) x *= 0.001;
    for (double& v : frame.velocities) v *= 0.001;
  }
  const auto pictures = plot_orbits(frames, 199, 1.0, "xy", {}, km);
  CHECK(pictures[0].views[0].across_label == "x from Sun (km)");
  for (const PlotPlace& p : pictures[0].orbits[1].path) CHECK(std::abs(std::hypot(p[0], p[1]) - 149'597.870'7) < 0.1);
}

/// A monitor of elements of a primary and two bodies: at the first look others than at the last.
io::MonitorSeries elements_seen() {
  io::MonitorSeries monitor{
      .name = "elements", .step = {0, 1}, .time = {0, 10}, .quantities = {}, .units = {}, .scale = {}, .orders = {}};
  auto& [shape, values] = monitor.quantities["value"];
  shape = {3, 6};
  for (const double a : {0.001, 0.002}) {
    values.insert(values.end(), 6, NAN);
    values.insert(values.end(), {a, 0.5, 0, 0, 0, M_PI});  // at its apocenter
    values.insert(values.end(), {-a, 1.5, 0, 0, 0, 1});    // comes from infinity
  }
  return monitor;
}

TEST_CASE("without frames the orbits are the ellipses of the last elements", "[cli][plot]") {
  io::Frames shared = circles(2, 0, 0, 1);
  PlotSource source{
      .file = {}, .scene = {}, .frames = shared, .monitors = {elements_seen()}, .time = time_axis("1", {}, 0, 10)};
  const auto pictures = plot_orbits_of_elements(source);
  REQUIRE(pictures.size() == 1);
  CHECK(pictures[0].title == "Orbits at t = 10");
  REQUIRE(pictures[0].orbits.size() == 2);  // what is not bound has no ellipse
  CHECK(pictures[0].orbits[0].primary);
  const PlotOrbit& orbit = pictures[0].orbits[1];
  CHECK(std::abs(orbit.end[0] + 0.003) < 1e-12);
  const auto [nearest, farthest] = std::minmax_element(orbit.path.begin(), orbit.path.end());
  CHECK(std::abs((*nearest)[0] + 0.003) < 1e-12);
  CHECK(std::abs((*farthest)[0] - 0.001) < 1e-12);
  REQUIRE(plot_orbits_of_elements(source, "yz")[0].views.size() == 1);
  CHECK(plot_orbits_of_elements(source, "yz")[0].views[0].across == 1);
  CHECK(plot_orbits_of_elements(source, "all")[0].views.size() == 3);
  source.monitors.clear();
  CHECK(plot_orbits_of_elements(source).empty());
}

TEST_CASE("marks of an axis are short: very small and very large numbers leave a power of ten to its name",
          "[cli][plot]") {
  const auto texts = [](double low, double high, double most) {
    std::string all;
    for (const auto& [at, text] : marks_of(low, high, most).marks) all += (all.empty() ? "" : " ") + text;
    return all;
  };
  CHECK(texts(0, 1.05, 6) == "0 0.2 0.4 0.6 0.8 1");
  CHECK(texts(-1, 1, 4) == "-1 -0.5 0 0.5 1");
  CHECK(texts(0, 3.9e-5, 7) == "0 0.5 1 1.5 2 2.5 3 3.5");
  CHECK(marks_of(0, 3.9e-5, 7).power == -5);
  CHECK(std::abs(marks_of(0, 3.9e-5, 7).marks[1].first - 5e-6) < 1e-20);
  CHECK(texts(-1.3e6, 1.3e6, 5) == "-1 -0.5 0 0.5 1");
  CHECK(marks_of(-1.3e6, 1.3e6, 5).power == 6);
  CHECK(texts(0, 40'000, 4) == "0 10000 20000 30000 40000");
  CHECK(texts(5.20291, 5.20299, 4) == "5.20292 5.20294 5.20296 5.20298");
  CHECK(texts(1, 1, 5).empty());
  CHECK(with_power("y", -5) == "y (10\u207b\u2075)");
  CHECK(with_power("x from Saturn (km)", 6) == "x from Saturn (10\u2076 km)");
  CHECK(with_power("e", 0) == "e");
  CHECK(with_power("", -14) == "in 10\u207b\u00b9\u2074");
  CHECK(marks_of(-0.1e6, 0.1e6, 3, 6).marks.back().second == "0.1");  // a side view beside one of 10^6
  const PlotMarks decades = decade_marks_of(150'000, 1.3e6);
  CHECK(decades.power == 6);
  REQUIRE(decades.marks.size() == 3);
  CHECK(decades.marks[0] == std::pair(200'000.0, std::string("0.2")));
  CHECK(decades.marks[2].second == "1");
  for (double size = 1e-30; size < 1e30; size *= 7.3) {
    CAPTURE(size);
    const PlotMarks marks = marks_of(-0.3 * size, size, 7);
    CHECK((marks.marks.size() > 2 && marks.marks.size() < 14));
    for (const auto& [at, text] : marks.marks) {
      CHECK(text.size() < 8);
      CHECK(std::abs(std::stod(text) * std::pow(10.0, marks.power) - at) < 1e-9 * size);
    }
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

// What a picture of a liquid is made of: g(r) against lattices and ideal gases, displacements across the box's edge,
// the discs, bonds and legend of a box.

#include "cli/plot_script.hpp"
#include "cli/plot_source.hpp"
#include "tests/cli/support.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#if NOETHER_HDF5

namespace noether::test {
namespace {

/// Frames of particles of mass 1 in a cube.
io::Frames frames_in_cube(std::size_t n, double edge, std::size_t count) {
  io::Frames frames;
  frames.length_unit = frames.time_unit = "1";
  frames.masses.assign(n, 1.0);
  frames.names.assign(n, "atom");
  for (std::size_t k = 0; k < count; ++k) {
    io::Frame frame;
    frame.time = 0.5 * static_cast<double>(k);
    frame.positions.assign(3 * n, 0.0);
    frame.velocities.assign(3 * n, 0.0);
    frame.images.assign(3 * n, 0);
    frame.edges = {edge, edge, edge};
    frames.frames.push_back(std::move(frame));
  }
  return frames;
}

/// A simple cubic lattice of unit spacing, six sites along an edge.
io::Frames cubic_lattice() {
  io::Frames frames = frames_in_cube(216, 6, 1);
  std::vector<double>& x = frames.frames[0].positions;
  for (std::size_t i = 0; i < 216; ++i) {
    x[3 * i] = static_cast<double>(i % 6), x[3 * i + 1] = static_cast<double>(i / 6 % 6);
    x[3 * i + 2] = static_cast<double>(i / 36);
  }
  return frames;
}

/// How many neighbors g(r) has between two distances: density times the integral over the shells.
double neighbors(const PlotCurve& g, double from, double to, double others, double volume) {
  const double width = 2 * g.points[0].x;
  double count = 0;
  for (const PlotPoint& p : g.points) {
    const double inner = p.x - width / 2, outer = p.x + width / 2;
    if (p.x < from || p.x > to) continue;
    count += p.y * others / volume * 4 * M_PI / 3 * (outer * outer * outer - inner * inner * inner);
  }
  return count;
}

TEST_CASE("g(r) of a simple cubic lattice has 6, 12, 8 and 6 neighbors at 1, sqrt 2, sqrt 3 and 2", "[cli][plot]") {
  const auto curves = radial_distributions(cubic_lattice(), {0});
  REQUIRE(curves.size() == 1);
  const PlotCurve& g = curves[0];
  CHECK(std::abs(g.points.back().x + g.points[0].x - 3) < 1e-12);  // half of the edge
  CHECK(std::abs(neighbors(g, 0.8, 1.2, 215, 216) - 6) < 1e-9);
  CHECK(std::abs(neighbors(g, 1.25, 1.6, 215, 216) - 12) < 1e-9);
  CHECK(std::abs(neighbors(g, 1.6, 1.85, 215, 216) - 8) < 1e-9);
  CHECK(std::abs(neighbors(g, 1.85, 2.15, 215, 216) - 6) < 1e-9);
  CHECK(neighbors(g, 0, 0.9, 215, 216) == 0);
}

TEST_CASE("g(r) by pair of types counts neighbors of each type", "[cli][plot]") {
  io::Frames frames = cubic_lattice();
  for (std::size_t i = 0; i < 216; ++i) frames.types.push_back((i % 6 + i / 6 + i / 36) % 2 == 0 ? "Na" : "Cl");
  const auto curves = radial_distributions(frames, {0});
  REQUIRE(curves.size() == 3);
  CHECK(curves[0].name == "Cl-Cl");
  CHECK(curves[1].name == "Cl-Na");
  CHECK(curves[2].name == "Na-Na");
  CHECK(std::abs(neighbors(curves[1], 0.8, 1.2, 108, 216) - 6) < 1e-9);  // the nearest are all of the other type
  CHECK(neighbors(curves[0], 0.8, 1.2, 107, 216) == 0);
  CHECK(std::abs(neighbors(curves[2], 1.25, 1.6, 107, 216) - 12) < 1e-9);
}

/// An ideal gas of molecules of two atoms at a distance of 0.3.
io::Frames gas_of_pairs(std::size_t molecules, ParticleLinks& links) {
  io::Frames frames = frames_in_cube(2 * molecules, 5, 8);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> anywhere(0, 5);
  std::normal_distribution<double> normal;
  for (io::Frame& frame : frames.frames) {
    for (std::size_t m = 0; m < molecules; ++m) {
      Vec3<double> way(normal(random), normal(random), normal(random));
      way *= 0.3 / way.norm();
      for (Index k = 0; k < 3; ++k) {
        const double x = anywhere(random), y = x + way[k];
        const std::size_t at = 6 * m + static_cast<std::size_t>(k);
        frame.positions[at] = x, frame.positions[at + 3] = y - 5 * std::floor(y / 5);
      }
    }
  }
  for (std::size_t m = 0; m < molecules; ++m) links.pairs.emplace_back(2 * m, 2 * m + 1);
  return frames;
}

TEST_CASE("g(r) of molecules leaves out the pairs within one, and is 1 for an ideal gas of them", "[cli][plot]") {
  ParticleLinks links;
  const io::Frames frames = gas_of_pairs(200, links);
  PlotSource source{.file = {}, .scene = {}, .frames = frames, .monitors = {}, .time = time_axis("1", {}, 0, 4)};
  source.links = links;
  const auto between = plot_radial_distribution(source, false);
  REQUIRE(between);
  CHECK(has(between->title, "g(r) between molecules, mean of "));
  const auto worst_near = [](const PlotCurve& g) {
    double worst = 0;
    for (const PlotPoint& p : g.points) {
      if (std::abs(p.x - 0.3) < 0.1) worst = std::max(worst, p.y);
    }
    return worst;
  };
  CHECK(worst_near(between->curves.at(0)) < 2);
  const auto all = radial_distributions(frames, {0, 1, 2, 3, 4, 5, 6, 7});
  CHECK(worst_near(all.at(0)) > 4);  // the bonds
  const auto some = radial_distributions(frames, {0, 1, 2, 3, 4, 5, 6, 7}, molecules_of(400, links));
  double sum = 0, weights = 0;
  for (const PlotPoint& p : some.at(0).points) sum += p.y * p.x * p.x, weights += p.x * p.x;
  CHECK(std::abs(sum / weights - 1) < 0.01);

  // One molecule of all: nothing would be left, so that all pairs count, and the title says so.
  for (std::size_t i = 0; i + 1 < 400; ++i) source.links.pairs.emplace_back(i, i + 1);
  const auto network = plot_radial_distribution(source, false);
  REQUIRE(network);
  CHECK(has(network->title, "g(r), bonded pairs too, mean of "));
  CHECK(worst_near(network->curves.at(0)) > 4);
}

TEST_CASE("molecules are what links join", "[cli][plot]") {
  ParticleLinks links;
  links.pairs = {{4, 1}, {1, 2}, {5, 0}};
  CHECK(molecules_of(6, links) == std::vector<std::size_t>{0, 1, 1, 2, 1, 0});
}

TEST_CASE("a diffusion coefficient is told where displacements grow as time, within 0.1 of its first power",
          "[cli][plot]") {
  const auto title_of = [](double power) {
    io::MonitorSeries monitor{.name = "mean_square_displacement",
                              .step = {},
                              .time = {},
                              .quantities = {},
                              .units = {},
                              .scale = {},
                              .orders = {}};
    for (const char* quantity : {"lag", "value"}) monitor.quantities[quantity].first = {40};
    for (const double worse : {3.0, 1.0}) {  // the last look counts
      for (int k = 0; k < 40; ++k) {
        const double lag = 0.1 * k;
        monitor.quantities["lag"].second.push_back(lag);
        monitor.quantities["value"].second.push_back(worse * 3 * std::pow(lag, power));
      }
    }
    PlotSource source{.file = {}, .scene = {}, .frames = {}, .monitors = {monitor}, .time = time_axis("1", {}, 0, 4)};
    const auto panel = plot_mean_square_displacement(source);
    REQUIRE(panel);
    return panel->title;
  };
  CHECK(title_of(1) == "Mean square displacement: D = 0.5");
  CHECK(has(title_of(1.09), ": D = "));
  CHECK(has(title_of(0.91), ": D = "));
  CHECK(title_of(1.12) == "Mean square displacement: grows as t^1.1");
  CHECK(title_of(0.88) == "Mean square displacement: grows as t^0.88");
  CHECK(title_of(2) == "Mean square displacement: grows as t^2");
}

TEST_CASE("g(r) of more particles than are counted has every type, in whatever order they stand", "[cli][plot]") {
  io::Frames frames = frames_in_cube(6912, 10, 1);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(0, 10);
  for (double& x : frames.frames[0].positions) x = anywhere(random);
  for (std::size_t i = 0; i < 6912; ++i) frames.types.push_back(i % 3 == 0 ? "O" : "H");
  const auto curves = radial_distributions(frames, {0});
  REQUIRE(curves.size() == 3);
  for (const PlotCurve& g : curves) CHECK(std::abs(g.points.back().y - 1) < 0.1);
}

TEST_CASE("a pressure about zero is told with its error", "[cli][plot]") {
  io::MonitorSeries pressure{
      .name = "pressure", .step = {}, .time = {}, .quantities = {}, .units = {}, .scale = {}, .orders = {}};
  for (int k = 0; k < 400; ++k) {
    pressure.time.push_back(k);
    pressure.quantities["value"].second.push_back((k / 20 % 2 == 0 ? 12.0 : -12.0) - 0.1234);
  }
  PlotSource source{.file = {}, .scene = {}, .frames = {}, .monitors = {pressure}, .time = time_axis("1", {}, 0, 400)};
  source.pressure_unit = "bar";
  const auto panel = plot_pressure(source);
  REQUIRE(panel);
  CHECK(panel->title == "Pressure: mean -0.1 +- 4 bar in the second half");
}

TEST_CASE("g(r) of an ideal gas is 1", "[cli][plot]") {
  io::Frames frames = frames_in_cube(400, 5, 8);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(0, 5);
  std::vector<std::size_t> chosen;
  for (io::Frame& frame : frames.frames) {
    for (double& x : frame.positions) x = anywhere(random);
    chosen.push_back(chosen.size());
  }
  const auto curves = radial_distributions(frames, chosen);
  REQUIRE(curves.size() == 1);
  for (const PlotPoint& p : curves[0].points) {
    const double width = 2 * curves[0].points[0].x;
    const double pairs = 8 * 400 * 399.0 / 2 * 4 * M_PI * p.x * p.x * width / 125;
    CAPTURE(p.x, pairs);
    CHECK(std::abs(p.y - 1) < 5 / std::sqrt(pairs) + 0.05 * (p.x < 0.1));
  }
}

TEST_CASE("displacements are those of unwrapped positions about the center of mass", "[cli][plot]") {
  io::Frames frames = frames_in_cube(2, 2, 9);
  for (io::Frame& frame : frames.frames) {  // +-3 along x, and a drift of 5 along y that is no diffusion
    for (const std::size_t i : {0U, 1U}) {
      const double x = (i == 0 ? 3 : -3) * frame.time + 0.5, y = 5 * frame.time;
      frame.images[3 * i] = static_cast<std::int32_t>(std::floor(x / 2));
      frame.images[3 * i + 1] = static_cast<std::int32_t>(std::floor(y / 2));
      frame.positions[3 * i] = x - 2 * std::floor(x / 2);
      frame.positions[3 * i + 1] = y - 2 * std::floor(y / 2);
    }
  }
  const std::vector<PlotPoint> points = mean_square_displacement(frames);
  REQUIRE(points.size() == 8);
  for (const PlotPoint& p : points) CHECK(std::abs(p.y - 9 * p.x * p.x) < 1e-10);
  CHECK(points[0].x == 0.5);
  CHECK(points[7].x == 4);

  PlotSource source{.file = {}, .scene = {}, .frames = frames, .monitors = {}, .time = time_axis("1", {}, 0, 4)};
  const auto panel = plot_mean_square_displacement(source);
  REQUIRE(panel);
  CHECK(panel->title == "Mean square displacement: grows as t^2");  // no diffusion coefficient is told
}

/// A chain of three across the edge of the box, and one particle alone.
ParticleSystem<double> chain_in_box() {
  ParticleSystem<double> s;
  for (const double x : {0.2, 1.2, 9.2, 5.0}) s.add("bead", 2, Vec3<double>(x, 5, 5), Vec3<double>::Zero());
  s.set_box(Box::periodic({10, 10, 10}));
  auto topology = std::make_shared<Topology>();
  topology->type_names = {"A", "B"};
  topology->types = {0, 0, 0, 1};
  topology->bonds = {{.particles = {0, 1}, .type = 0}, {.particles = {0, 2}, .type = 0}};
  s.set_topology(std::move(topology));
  return s;
}

TEST_CASE("a box shows types as its legend, and bonds that do not cross it", "[cli][plot]") {
  std::vector<PlotLegend> legend;
  const PlotBox box = plot_box(chain_in_box(), "u", legend);
  CHECK(box.discs.size() == 4);
  CHECK(box.sticks.size() == 2);  // the two halves of one bond; the other one crosses
  CHECK(box.far_edges.size() == 3);
  CHECK(box.near_edges.size() == 9);
  REQUIRE(legend.size() == 2);
  CHECK(legend[0].name == "3 of A, mass 2 u");
  CHECK(legend[1].name == "1 of B, mass 2 u");
  for (std::size_t k = 1; k < box.discs.size(); ++k) CHECK(box.discs[k - 1].depth >= box.discs[k].depth);
  for (const PlotDisc& disc : box.discs) {
    CHECK((disc.x > box.low.x && disc.x < box.high.x && disc.y > box.low.y && disc.y < box.high.y));
  }
}

TEST_CASE("particles that others hide are not drawn, and many have one line of legend", "[cli][plot]") {
  ParticleSystem<double> s;
  for (int i = 0; i < 8000; ++i) {
    s.add("p" + std::to_string(i), 1, Vec3<double>(i % 20 + 0.5, i / 20 % 20 + 0.5, i / 400 + 0.5),
          Vec3<double>::Zero());
  }
  s.set_box(Box::periodic({20, 20, 20}));
  std::vector<PlotLegend> legend;
  const PlotBox box = plot_box(s, "1", legend);
  CHECK(legend.size() == 1);
  CHECK(box.discs.size() < 4000);
  CHECK(box.discs.size() >= 1141);  // three faces of the cube
}

const std::string melt = R"(title = "A melt"
units = "reduced"
[particles]
type = "lattice"
cells = [3, 3, 3]
density = 0.8
mass = 1
temperature = 1
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "lennard_jones"
cutoff = 1.8
cutoff_style = "shifted"
epsilon = 1
sigma = 1
[integrator]
method = "verlet"
step = 0.005
steps = 40
[[every]]
type = "energy"
steps = 10
[[every]]
type = "trajectory"
steps = 10
)";

TEST_CASE("plot draws a melt: particles, temperature, g(r) and displacements, no legend of atoms",
          "[cli][plot][slow]") {
  const SceneFolder folder(melt);
  if (run_process({"gnuplot", "--version"}, folder.path()).exit_code != 0) {
    WARN("gnuplot is not installed: nothing is drawn");
    return;
  }
  output(folder, "run scene.toml --quiet --out out");
  output(folder, "plot out/run.h5 --out melt.svg");
  const std::string svg = read_text(folder / "melt.svg");
  for (const char* text : {"Frame 4, t = 0.2, box ", "Temperature: mean ",
                           "Radial distribution function, mean of 3 frames", "Mean square displacement", "108 of "}) {
    CAPTURE(text);
    CHECK(has(svg, text));
  }
  output(folder, "plot out/run.h5 --out melt.png");
  output(folder, "plot out/run.h5 --out melt.pdf --what rdf --frame 0");
  CHECK(read_text(folder / "melt.png").size() > 50'000);
  CHECK(read_text(folder / "melt.pdf").starts_with("%PDF"));
  const ProcessResult frame = noether(folder, "plot out/run.h5 --frame 5");
  CHECK(frame.exit_code == 2);
  CHECK(frame.err == "--frame 5: out/run.h5 has the frames 0 to 4; -1 is the last\n");
  const ProcessResult what = noether(folder, "plot out/run.h5 --what rfd");
  CHECK(what.exit_code == 2);
  CHECK(what.err == "--what 'rfd' is not one of the panels; did you mean 'rdf'?\n");
  CHECK(noether(folder, "plot out/run.h5 --what pressure").err ==
        "out/run.h5 has no pressure to draw; it needs the monitor pressure\n");
  CHECK(noether(folder, "plot out/run.h5 --projection zz").err ==
        "--projection 'zz' is not one of xy, xz, yz and all\n");
}

}  // namespace
}  // namespace noether::test

#endif

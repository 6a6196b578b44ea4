// How pictures read a run: frame by frame, with the frames that can be drawn, by what its scene says.

#include "cli/plot_source.hpp"
#include "cli/run_gravity.hpp"
#include "io/inspect.hpp"
#include "scene/parts.hpp"
#include "tests/cli/support.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#if NOETHER_HDF5

namespace noether::test {
namespace {

/// The most memory that this process has had so far, in MiB; 0 where a sanitizer keeps what is freed.
double peak_memory() {
#if defined(__SANITIZE_ADDRESS__)
  return 0;
#else
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
#endif
}

/// Frames that are made when they are asked for: particles of mass 1 that go along x, each faster than the one before,
/// in a box of edge 1 where they are in one. @param reads  counts them
PlotFrames made_frames(std::size_t n, std::size_t count, bool periodic, std::size_t& reads) {
  io::Frames shared;
  shared.length_unit = shared.time_unit = "1";
  shared.masses.assign(n, 1);
  shared.names.assign(n, "p");
  std::vector<double> times;
  for (std::size_t k = 0; k < count; ++k) times.push_back(0.25 * static_cast<double>(k));
  return {shared, times, [=, &reads](std::size_t k) {
            ++reads;
            io::Frame frame{
                .step = static_cast<std::int64_t>(k), .time = times.at(k), .positions = {}, .velocities = {}};
            frame.positions.assign(3 * n, 0), frame.velocities.assign(3 * n, 0);
            if (periodic) frame.images.assign(3 * n, 0), frame.edges = {1, 1, 1};
            for (std::size_t i = 0; i < n; ++i) {
              const double speed = static_cast<double>(i % 7) - 3, x = speed * frame.time + 0.125;
              const double crossings = periodic ? std::floor(x) : 0;
              frame.positions[3 * i] = x - crossings, frame.velocities[3 * i] = speed;
              if (periodic) frame.images[3 * i] = static_cast<std::int32_t>(crossings);
            }
            return frame;
          }};
}

TEST_CASE("a picture of very many frames holds few of them in memory", "[cli][plot]") {
  std::size_t reads = 0;
  SECTION("of few bodies") {
    const PlotFrames frames = made_frames(3, 200'000, false, reads);  // 29 MB of numbers, 60 MB of frames
    const KeptFrames kept = kept_frames(frames, 20'000, 123'457);
    CHECK(kept.frames.frames.size() <= 20'000);
    CHECK(kept.frames.frames.at(kept.shown).step == 123'457);
    CHECK(kept.frames.frames[1].step - kept.frames.frames[0].step == 10);
    reads = 0;
    const auto pictures = plot_orbits(frames, 199'999, {}, "xy");
    CHECK(reads <= 20'001);
    REQUIRE(pictures.size() == 1);
    for (const PlotOrbit& orbit : pictures[0].orbits) CHECK(orbit.path.size() + orbit.samples.size() <= 22'000);
  }
  SECTION("of many particles: displacements") {
    // 60 frames of 50 000 particles are 290 MB in memory.
    const PlotFrames frames = made_frames(50'000, 60, true, reads);
    const double before = peak_memory();
    const auto points = mean_square_displacement(frames, 600'000);
    CHECK(peak_memory() - before < 60);
    REQUIRE(points.size() >= 20);
    // Speeds -3 to 3 about their mean: <v^2> = 4, but for the particles that are left out.
    for (const PlotPoint& p : points) CHECK(std::abs(p.y - 4 * p.x * p.x) < 0.02 * 4 * p.x * p.x);
  }
  SECTION("of many particles: temperature") {
    PlotSource source{.file = {},
                      .scene = {},
                      .frames = made_frames(50'000, 60, true, reads),
                      .monitors = {},
                      .time = time_axis("1", {}, 0, 15)};
    source.k_B = 1;
    const double before = peak_memory();
    const auto panel = plot_temperature(source);
    CHECK(peak_memory() - before < 60);
    REQUIRE(panel);
    CHECK(panel->curves.at(0).points.size() == 60);
  }
}

TEST_CASE("displacements of some particles are those of all types, whatever the order they stand in", "[cli][plot]") {
  // Every seventh particle rests: none of them is to be missed.
  std::size_t reads = 0;
  const auto some = mean_square_displacement(made_frames(14'000, 9, true, reads), 27'000);
  const auto all = mean_square_displacement(made_frames(14'000, 9, true, reads));
  REQUIRE(some.size() == all.size());
  for (std::size_t k = 0; k < all.size(); ++k) CHECK(std::abs(some[k].y / all[k].y - 1) < 0.02);
}

TEST_CASE("more bodies than paths have points are drawn from the side that is asked for", "[cli][plot]") {
  std::size_t reads = 0;
  const auto pictures = plot_orbits(made_frames(130'000, 2, false, reads), 1, {}, "xy");
  REQUIRE(pictures.size() == 1);
  CHECK(pictures[0].orbits.size() == 130'000);
}

TEST_CASE("of monitors the samples that are wanted are read, and of too many some, the last among them",
          "[cli][plot]") {
  const SceneFolder folder(two_bodies + "[[every]]\ntype = \"elements\"\nsteps = 1\n");
  output(folder, "run scene.toml --quiet");
  const auto file = folder / "scene.out/run.h5";
  const auto drawn = [](const std::string& monitor, const std::string& quantity) {
    return monitor == "elements" || quantity == "relative_error";
  };
  const auto all = io::read_monitors(file, {.wanted = drawn});
  REQUIRE(all.size() == 3);  // angular momentum, elements, energy
  for (const io::MonitorSeries& one : all) CHECK(one.quantities.size() == 1);
  CHECK(all[1].time.size() == 101);
  const auto some = io::read_monitors(file, {.wanted = drawn, .most_numbers = 300});
  REQUIRE(some.size() == 3);
  CHECK(some[0].time == all[0].time);  // single numbers stay
  REQUIRE(some[1].time.size() == 21);  // 101 samples of 12 numbers: each fifth
  CHECK(some[1].time.back() == all[1].time.back());
  CHECK(some[1].step[1] == 5);
  const auto &values = all[1].quantities.at("value").second, &kept = some[1].quantities.at("value").second;
  REQUIRE(kept.size() == 21 * 12);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const double there = values[(k / 12) * 5 * 12 + k % 12];
    CHECK((kept[k] == there || (std::isnan(kept[k]) && std::isnan(there))));
  }
}

TEST_CASE("of a monitor whose last sample alone is drawn no other is read", "[cli][plot]") {
  const SceneFolder folder(two_bodies + "[[every]]\ntype = \"elements\"\nsteps = 1\n");
  output(folder, "run scene.toml --quiet");
  const auto file = folder / "scene.out/run.h5";
  const auto all = io::read_monitors(file);
  const auto last = io::read_monitors(file, {.last_alone = [](const std::string& name) { return name == "elements"; }});
  REQUIRE(all.size() == last.size());
  for (std::size_t m = 0; m < all.size(); ++m) {
    const bool alone = all[m].name == "elements";
    CHECK(last[m].step.size() == (alone ? 1 : all[m].step.size()));
    CHECK(last[m].step.back() == all[m].step.back());
    CHECK(last[m].time.back() == all[m].time.back());
    for (const auto& [quantity, content] : all[m].quantities) {
      const std::vector<double>& values = last[m].quantities.at(quantity).second;
      REQUIRE(content.second.size() == values.size() * (alone ? all[m].step.size() : 1));
      const auto from = content.second.end() - static_cast<std::ptrdiff_t>(values.size());
      for (std::size_t k = 0; k < values.size(); ++k)
        CHECK((values[k] == from[static_cast<std::ptrdiff_t>(k)] || std::isnan(values[k])));
    }
  }
}

TEST_CASE("of samples at equal distances the first is kept too: changes are counted from it", "[cli][plot]") {
  std::string scene = two_bodies + "[[every]]\ntype = \"elements\"\nsteps = 1\n";
  scene.replace(scene.find("steps = 100"), 11, "steps = 30000");  // more numbers than one block of rows has
  const SceneFolder folder(scene);
  output(folder, "run scene.toml --quiet");
  const auto elements = [](const std::string& monitor, const std::string&) { return monitor == "elements"; };
  const auto all = io::read_monitors(folder / "scene.out/run.h5", {.wanted = elements});
  REQUIRE(all.size() == 1);
  REQUIRE(all[0].time.size() == 30'001);
  const auto& values = all[0].quantities.at("value").second;
  for (const std::size_t stride : {std::size_t{7}, std::size_t{6924}}) {
    CAPTURE(stride);
    const std::size_t most = (30'001 * 12 + stride - 1) / stride;
    const auto some = io::read_monitors(folder / "scene.out/run.h5", {.wanted = elements, .most_numbers = most});
    const std::vector<std::int64_t>& steps = some.at(0).step;
    CHECK(steps.size() == 2 + (30'000 / stride));
    CHECK(steps[0] == 0);
    CHECK(steps[1] == static_cast<std::int64_t>(30'000 % stride));
    CHECK(steps.back() == 30'000);
    const auto& kept = some[0].quantities.at("value").second;
    REQUIRE(kept.size() == steps.size() * 12);
    for (std::size_t k = 0; k < steps.size(); ++k) {
      CHECK(some[0].time[k] == all[0].time[static_cast<std::size_t>(steps[k])]);
      const std::size_t planet = 12 * static_cast<std::size_t>(steps[k]) + 6;
      CHECK(kept[12 * k + 6] == values[planet]);
      CHECK(kept[12 * k + 11] == values[planet + 5]);
    }
  }
}

/// A small melt with every monitor of liquids that a picture has a panel for, and without frames.
const std::string watched_melt = R"(units = "reduced"
[particles]
type = "lattice"
cells = [2, 2, 2]
density = 0.8442
mass = 1
temperature = 1.44
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "lennard_jones"
cutoff = 1.5
epsilon = 1
sigma = 1
[integrator]
method = "verlet"
step = 0.005
steps = 60
[[every]]
type = "temperature"
steps = 10
[[every]]
type = "pressure"
steps = 10
[[every]]
type = "radial_distribution"
steps = 10
[[every]]
type = "dihedrals"
quadruples = [["atom_1", "atom_2", "atom_3", "atom_9"], ["atom_5", "atom_6", "atom_7", "atom_12"]]
steps = 10
[[every]]
type = "mean_square_displacement"
steps = 2
length = 20
[[every]]
type = "momentum"
steps = 10
[[every]]
type = "energy"
steps = 10
)";

TEST_CASE("the monitors that pictures are drawn from are read, each with what its panel needs", "[cli][plot]") {
  const SceneFolder folder(watched_melt);
  output(folder, "run scene.toml --quiet");
  const auto panels_of = [&](const std::string& what) {
    const PlotOptions options{.frame = {}, .what = {what}, .projection = {}};
    return read_plot_data(folder / "scene.out/run.h5", standard_parts(), options).panels;
  };
  for (const char* what : {"errors", "temperature", "pressure", "dihedrals", "rdf", "msd"}) {
    CAPTURE(what);
    const std::vector<PlotPanel> panels = panels_of(what);
    REQUIRE(panels.size() == (what == std::string("errors") ? 2 : 1));  // energy and momentum
    for (const PlotPanel& panel : panels) {
      REQUIRE_FALSE(panel.curves.empty());
      CHECK(panel.curves[0].points.size() > 2);
    }
  }
}

TEST_CASE("the panel of dihedral angles has their last histogram, in percent per degree", "[cli][plot]") {
  io::MonitorSeries monitor{
      .name = "dihedrals", .step = {}, .time = {0, 1}, .quantities = {}, .units = {}, .scale = {}, .orders = {}};
  const double quarter = std::numbers::pi / 4;
  monitor.quantities["angle"] = {{2}, {-2 * quarter, 2 * quarter, -2 * quarter, 2 * quarter}};
  monitor.quantities["density"] = {{2}, {0, 0, 0.25 / std::numbers::pi, 0.75 / std::numbers::pi}};
  monitor.quantities["fraction"] = {{3}, {1, 0, 0, 0.6, 0.3, 0.1}};
  PlotSource source{.file = {}, .scene = {}, .frames = {}, .monitors = {monitor}, .time = {}};
  const std::optional<PlotPanel> panel = plot_dihedrals(source);
  REQUIRE(panel);
  CHECK(panel->title == "Dihedrals: trans 0.600, gauche+ 0.300, gauche- 0.100");
  REQUIRE(panel->curves.size() == 1);
  REQUIRE(panel->curves[0].points.size() == 2);
  CHECK(std::abs(panel->curves[0].points[1].x - 90) < 1e-12);
  CHECK(std::abs(panel->curves[0].points[1].y - 75.0 / 180) < 1e-12);
  source.monitors[0].name = "temperature";
  CHECK_FALSE(plot_dihedrals(source));
}

/// Titles of the panels of a run's picture.
std::vector<std::string> titles_of(const PlotData& data) {
  std::vector<std::string> titles;
  for (const PlotPanel& panel : data.panels) titles.push_back(panel.title);
  return titles;
}

const PlotPanel* panel_called(const PlotData& data, const std::string& title) {
  const auto found =
      std::find_if(data.panels.begin(), data.panels.end(), [&](const auto& p) { return p.title == title; });
  return found == data.panels.end() ? nullptr : &*found;
}

/// A heavy and a light body with a force.
std::string pair_with(const std::string& force) {
  return "units = \"reduced\"\n[particles]\nbody = [{ name = \"heavy\", mass = 1, x = [0, 0, 0], v = [0, 0, 0] }, { "
         "name = "
         "\"light\", mass = 0.001, x = [1, 0, 0], v = [0, 1, 0] }]\n[hamiltonian]\ntype = "
         "\"kinetic_potential\"\n[[hamiltonian.force]]\n" +
         force +
         "\n[integrator]\nmethod = \"verlet\"\nstep = 0.01\nsteps = 300\n[[every]]\ntype = \"trajectory\"\nsteps = "
         "10\n";
}

TEST_CASE("elements are those of the scene's G, a whole number too", "[cli][plot]") {
  for (const char* G : {"G = 2", "G = 2.0"}) {
    CAPTURE(G);
    std::string scene = pair_with(std::string("type = \"gravity\"\n") + G);
    const SceneFolder folder(scene.replace(scene.find("[0, 1, 0]"), 9, "[0, 1.4142, 0]"));
    output(folder, "run scene.toml --quiet");
    const PlotData data = read_plot_data(folder / "scene.out/run.h5", standard_parts());
    const PlotPanel* a = panel_called(data, "Semi-major axis");
    REQUIRE(a != nullptr);  // with G = 1 of reduced units the body would not be bound: a < 0
    REQUIRE(a->curves.size() == 1);
    for (const PlotPoint& p : a->curves[0].points) CHECK(std::abs(p.y - 1) < 0.01);
  }
}

TEST_CASE("where masses do not attract each other there are no elements and no primary", "[cli][plot]") {
  const SceneFolder folder(pair_with("type = \"harmonic_field\"\nk = 1"));
  output(folder, "run scene.toml --quiet");
  const PlotData data = read_plot_data(folder / "scene.out/run.h5", standard_parts());
  for (const std::string& title : titles_of(data)) {
    CAPTURE(title);
    CHECK_FALSE(has(title, "Semi-major"));
    CHECK_FALSE(has(title, "Eccentricity"));
  }
  REQUIRE(data.orbits.size() == 1);
  CHECK(data.orbits[0].views[0].across_label == "x");
  for (const PlotOrbit& orbit : data.orbits[0].orbits) CHECK_FALSE(orbit.primary);
  const ProcessResult asked = noether(folder, "plot scene.out/run.h5 --what elements");
  CHECK(asked.exit_code == 2);
  CHECK(has(asked.err, "has no elements to draw"));
}

TEST_CASE("a frame is shown by its number in the file, also beside frames that failed", "[cli][plot]") {
  const SceneFolder folder(pair_with("type = \"gravity\""));
  output(folder, "run scene.toml --quiet");
  const auto place_at = [&](std::int64_t frame) {
    const PlotData data = read_plot_data(folder / "scene.out/run.h5", standard_parts(), {.frame = frame});
    return data.orbits.at(0).orbits.at(1).end;
  };
  const PlotPlace third = place_at(3), tenth = place_at(10), last = place_at(30);
  const std::string code =
      "import h5py; f = h5py.File('scene.out/run.h5', 'r+'); "
      "f['/particles/system/position/value'][4:6, 1, 0] = float('nan'); "
      "f['/particles/system/velocity/value'][30, 0, 2] = float('inf')";
  if (std::string(NOETHER_PYTHON).empty() || run_process({NOETHER_PYTHON, "-c", code}, folder.path()).exit_code != 0) {
    WARN("there is no Python with h5py: the frames are not spoiled");
    return;
  }
  CHECK(place_at(3) == third);
  CHECK(place_at(10) == tenth);
  CHECK_FALSE(tenth == third);
  const PlotData whole = read_plot_data(folder / "scene.out/run.h5", standard_parts());
  CHECK(whole.orbits.at(0).orbits.at(1).end == place_at(29));  // the last one that can be drawn
  CHECK_FALSE(place_at(29) == last);
  CHECK(place_at(-1) == place_at(29));
  for (const char* frame : {"4", "30"}) {
    const ProcessResult failed = noether(folder, fmt::format("plot scene.out/run.h5 --frame {}", frame));
    CHECK(failed.exit_code == 2);
    CHECK(failed.err == fmt::format("--frame {} has numbers that are not finite: the run failed before it; choose "
                                    "another one\n",
                                    frame));
  }
  CHECK(noether(folder, "plot scene.out/run.h5 --frame 31").err ==
        "--frame 31: scene.out/run.h5 has the frames 0 to 30; -1 is the last\n");
}

TEST_CASE("a run without a title is called by its folder, or by its file", "[cli][plot]") {
  const SceneFolder folder(pair_with("type = \"gravity\""));
  output(folder, "run scene.toml --quiet --out orbit.out");
  CHECK(read_plot_data(folder / "orbit.out/run.h5", standard_parts()).title == "orbit");
  std::filesystem::copy(folder / "orbit.out/run.h5", folder / "kept.h5");
  CHECK(read_plot_data(folder / "kept.h5", standard_parts()).title == "kept");
  std::filesystem::create_directory(folder / "plain");
  std::filesystem::copy(folder / "orbit.out/run.h5", folder / "plain/run.h5");
  CHECK(read_plot_data(folder / "plain/run.h5", standard_parts()).title == "plain");
}

TEST_CASE("the primary is the heaviest body with most of the mass, whatever its place", "[cli][plot][view]") {
  CHECK(primary_of({1, 20, 0.5}) == 1);
  CHECK_FALSE(primary_of({1, 10, 0.5}));
  CHECK_FALSE(primary_of({5}));
  CHECK_FALSE(primary_of({}));
  SceneFolder folder(
      "units = \"reduced\"\n[particles]\nbody = [{ name = \"light\", mass = 0.001, x = [1, 0, 0], v = [0, 1, 0] }, { "
      "name = \"heavy\", mass = 1, x = [0, 0, 0], v = [0, 0, 0] }]\n[hamiltonian]\ntype = \"kinetic_potential\"\n"
      "[[hamiltonian.force]]\ntype = \"gravity\"\n[integrator]\nmethod = \"verlet\"\nstep = 0.01\nsteps = 300\n"
      "[[every]]\ntype = \"trajectory\"\nsteps = 10\n");
  output(folder, "run scene.toml --quiet");
  const PlotData data = read_plot_data(folder / "scene.out/run.h5", standard_parts());
  REQUIRE(data.orbits.size() == 1);
  CHECK(data.orbits[0].views[0].across_label == "x from heavy");
  CHECK(data.orbits[0].orbits[1].primary);
  CHECK(data.legend.at(1).color == primary_color);
  CHECK(data.legend.at(0).color == 0);
  const PlotPanel* a = panel_called(data, "Semi-major axis");
  REQUIRE(a != nullptr);
  REQUIRE(a->curves.size() == 1);
  for (const PlotPoint& p : a->curves[0].points) CHECK(std::abs(p.y - 1) < 0.01);
  output(folder, "view scene.out/run.h5 --out page.html");
  CHECK(has(read_text(folder / "page.html"), "\"primary\":1"));
}

TEST_CASE("plot and view read times in the same unit", "[cli][plot][view]") {
  CHECK(readable_time("day", 700).unit == "day");
  CHECK(readable_time("day", 731).unit == "yr");
  CHECK(readable_time("day", 6 * 365'250.0).unit == "kyr");
  CHECK(readable_time("day", 1e9).unit == "Myr");
  CHECK(readable_time("ps", 1999).unit == "ps");
  CHECK(readable_time("ps", 2000).unit == "ns");
  CHECK(readable_time("ps", 2000).length == 1000);
  CHECK(readable_time("1", 1e12).unit.empty());
  for (const char* unit : {"day", "ps", "1", "s"}) {
    for (double longest = 1; longest < 1e12; longest *= 3) {
      const PlotTime of_plot = time_axis(unit, {}, 0, longest);
      const RunCaption of_view = caption_of({}, "run.h5", unit, longest, standard_parts());
      CHECK(of_plot.unit == of_view.time.unit);
      CHECK(of_plot.length == of_view.time.length);
    }
  }
}

}  // namespace
}  // namespace noether::test

#endif

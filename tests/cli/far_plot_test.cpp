// Pictures of runs that start far from the origin or from t = 0, and of files that a program of its own wrote.

#include "cli/plot_script.hpp"
#include "cli/plot_source.hpp"
#include "cli/view_data.hpp"
#include "engine/simulation.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "io/trajectory.hpp"
#include "scene/parts.hpp"
#include "tests/cli/support.hpp"
#include "tests/support/drivers.hpp"

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#if NOETHER_HDF5

namespace noether::test {
namespace {

/// Ten steps of free flight from a moment, written without a scene.
void write_free_flight(const std::filesystem::path& file, const ParticleSystem<double>& bodies, double dt,
                       double start = 0) {
  Simulation<double> run(bodies, compose(kinetic_potential(), schemes::verlet), dt, start);
  auto& writer = run.every(1, io::TrajectoryWriter(file));
  REQUIRE(run.run(10).ok());
  writer.finish(Outcome{});
}

/// The numbers of a block of a gnuplot script, row by row.
std::vector<std::vector<double>> rows_of_block(const std::string& script, const std::string& name) {
  const std::string opening = "$" + name + " << EOD\n";
  const std::size_t begin = script.find(opening);
  REQUIRE(begin != std::string::npos);
  std::vector<std::vector<double>> rows;
  std::istringstream text(script.substr(begin + opening.size()));
  for (std::string line; std::getline(text, line) && line != "EOD";) {
    std::istringstream numbers(line);
    std::vector<double> row;
    for (double x = 0; numbers >> x;) row.push_back(x);
    if (!row.empty()) rows.push_back(row);
  }
  return rows;
}

TEST_CASE("a file without a scene is shown about its primary", "[cli][plot][view]") {
  const ScratchFolder folder;
  ParticleSystem<double> bodies(unit_system("reduced"));
  bodies.add("light", 0.001, {1, 0, 0}, {0, 1, 0});
  bodies.add("heavy", 1, {0, 0, 0}, {0.5, 0, 0});
  write_free_flight(folder / "run.h5", bodies, 0.01);
  const PlotData data = read_plot_data(folder / "run.h5", standard_parts());
  REQUIRE(data.orbits.size() == 1);
  CHECK(data.orbits[0].views[0].across_label == "x from heavy");
  CHECK(data.orbits[0].orbits[1].primary);
  CHECK(read_view_data(folder / "run.h5", {}, standard_parts()).primary == 1);
}

TEST_CASE("rods far from the origin stay on their bodies, and their picture has a width", "[cli][plot]") {
  io::Frames frames;
  frames.length_unit = "m";
  frames.masses = {1, 1};
  frames.names = {"a", "b"};
  for (int k = 0; k < 5; ++k) {
    io::Frame frame;
    frame.time = k;
    frame.positions = {0.125 * k, 1e7, 0, 0.125 * k, 1e7 + 1, 0};
    frame.velocities = {0.125, 0, 0, 0.125, 0, 0};
    frames.frames.push_back(std::move(frame));
  }
  ParticleLinks links;
  links.pairs = {{0, 1}};
  PlotData data;
  data.orbits = plot_orbits(frames, 4, {}, "xy", links);
  const std::string script = plot_script(data, PictureFormat::svg, "picture");
  const auto rod = rows_of_block(script, "l0_0"), a = rows_of_block(script, "o0_0e"),
             b = rows_of_block(script, "o0_1e");
  REQUIRE(rod.size() == 2);
  CHECK(rod[0] == a.at(0));
  CHECK(rod[1] == b.at(0));
  CHECK(rod[1].at(1) - rod[0].at(1) == 1);
  const std::size_t at = script.find("set yrange [");
  REQUIRE(at != std::string::npos);
  const std::size_t colon = script.find(':', at);
  const double low = std::stod(script.substr(at + 12)), high = std::stod(script.substr(colon + 1));
  CHECK(std::abs(high - low - 1.08) < 1e-6);
}

TEST_CASE("the unit of time and its digits go by how long a run is, wherever its clock starts", "[cli][plot][view]") {
  CHECK(shown_time(2'451'545, 2'451'945) == 400);
  CHECK(shown_time(0, -1000) == 1000);
  CHECK(shown_time(1e6, 1e6) == 1e6);
  const PlotTime time = time_axis("day", {}, 2'451'545, 2'451'945);
  CHECK(time.unit == "day");
  CHECK(told_time(time, 2'451'545) == "2451545 day");
  CHECK(told_time(time, 2'451'546) == "2451546 day");
  CHECK(told_time(time_axis("day", {}, 0, 400), 399.94) == "399.9 day");
  CHECK(told_time(time_axis("1", {}, 0, 10), 10) == "10");
  const PlotMarks marks = marks_of(2'451'545, 2'451'945, 5);
  CHECK(marks.power == 0);
  REQUIRE(marks.marks.size() > 2);
  CHECK(marks.marks[0] == std::pair(2'451'600.0, std::string("2451600")));
  CHECK(marks_of(0, 2'451'945, 5).power == 6);
  CHECK(marks_of(1e20, 1.0001e20, 5).power == 20);  // nobody reads twenty figures

  // Long numbers leave what they share to the name of the axis.
  const PlotMarks far = marks_of(9'999'999.6, 10'000'001.4, 5);
  CHECK(far.offset == 9'999'990);
  REQUIRE(far.marks.size() > 2);
  CHECK(far.marks[0] == std::pair(10'000'000.0, std::string("10")));
  CHECK(far.marks[1] == std::pair(10'000'000.5, std::string("10.5")));
  CHECK(axis_name("y (m)", far) == "y - 9999990 (m)");
  CHECK(axis_name("y", marks_of(-10'000'001.4, -9'999'999.6, 5)) == "y + 10000010");
  CHECK(axis_name("time (day)", marks) == "time (day)");
  CHECK(axis_name("x (km)", marks_of(-1.3e6, 1.3e6, 5)) == "x (10\u2076 km)");

  const ScratchFolder folder;
  ParticleSystem<double> bodies(unit_system("solar"));
  bodies.add("Pluto", 6.6e-9, {0, 0, 0}, {0, 0, 0});
  bodies.add("Charon", 8e-10, {1.31e-4, 0, 0}, {0, 1e-7, 0});
  write_free_flight(folder / "run.h5", bodies, 40, 2'451'545);
  CHECK(read_view_data(folder / "run.h5", {}, standard_parts()).caption.time.unit == "day");
}

TEST_CASE("bodies without a primary that are close together are in kilometers", "[cli][plot]") {
  const ScratchFolder folder;
  ParticleSystem<double> bodies(unit_system("solar"));
  for (const double from : {0.0, 39.0}) {  // it is their distance that counts
    ParticleSystem<double> pair = bodies;
    pair.add("Pluto", 6.6e-9, {from, 0, 0}, {0, 0, 0});
    pair.add("Charon", 8e-10, {from + 1.31e-4, 0, 0}, {0, 1e-7, 0});
    write_free_flight(folder / "run.h5", pair, 0.5);
    const PlotData data = read_plot_data(folder / "run.h5", standard_parts(), {.projection = "xy"});
    REQUIRE(data.orbits.size() == 1);
    CHECK(data.orbits[0].views[0].across_label == "x (km)");
  }
  bodies.add("a", 1, {0, 0, 0}, {0, 0, 0});
  bodies.add("b", 1, {1, 0, 0}, {0, 1e-7, 0});
  write_free_flight(folder / "run.h5", bodies, 0.5);
  CHECK(read_plot_data(folder / "run.h5", standard_parts(), {.projection = "xy"}).orbits[0].views[0].across_label ==
        "x (au)");
}

}  // namespace
}  // namespace noether::test

#endif

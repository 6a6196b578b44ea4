// `noether plot` on runs of first-order systems: the curves that are drawn are the variables.

#include "tests/cli/support.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#if NOETHER_HDF5

namespace noether::test {
namespace {

/// Colours of the first variables, as gnuplot writes them.
const char* const colours[] = {"rgb(  0, 119, 187)", "rgb(238, 119,  51)", "rgb(  0, 153, 136)"};

std::string scene_of(const std::string& system, const std::string& end) {
  return "title = \"A system\"\nunits = \"reduced\"\n[system]\n" + system +
         "[integrator]\nmethod = \"rodas_5p\"\nrtol = 1e-9\n" + end;
}

/// The points of every line of a colour in an SVG of gnuplot's, in pixels from the upper left.
std::vector<std::vector<std::pair<double, double>>> lines(const std::string& svg, const std::string& colour) {
  std::vector<std::vector<std::pair<double, double>>> found;
  const std::string opening = "<path stroke='" + colour + "'  d='M";
  for (std::size_t at = 0; (at = svg.find(opening, at)) != std::string::npos;) {
    at += opening.size();
    std::string rest = svg.substr(at, svg.find('\'', at) - at);
    std::replace_if(
        rest.begin(), rest.end(), [](char c) { return c == 'L' || c == ','; }, ' ');
    std::vector<std::pair<double, double>> points;
    std::size_t read = 0;
    while (rest.find_first_not_of(' ') != std::string::npos) {
      const double x = std::stod(rest, &read);
      rest.erase(0, read);
      points.emplace_back(x, std::stod(rest, &read));
      rest.erase(0, read);
    }
    found.push_back(std::move(points));
  }
  return found;
}

double height_of(const std::vector<std::pair<double, double>>& line) {
  const auto by_height = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto [low, high] = std::minmax_element(line.begin(), line.end(), by_height);
  return high->second - low->second;
}

/// The picture of a scene's run; empty without gnuplot.
std::string picture_of(const std::string& scene) {
  const SceneFolder folder(scene);
  if (run_process({"gnuplot", "--version"}, folder.path()).exit_code != 0) {
    WARN("gnuplot is not installed: nothing is drawn");
    return "";
  }
  output(folder, "run scene.toml --quiet");
  CHECK(output(folder, "plot scene.out/run.h5") == "scene.out/run.svg\n");
  return read_text(folder / "scene.out/run.svg");
}

TEST_CASE("plot draws a system's variable against time, point by point", "[cli][plot][system][slow]") {
  const std::string svg = picture_of(
      scene_of("type = \"prothero_robinson\"\n", "until = 6\n[[every]]\ntype = \"trajectory\"\nevery = 0.1\n"));
  if (svg.empty()) return;
  const auto found = lines(svg, colours[0]);
  REQUIRE(found.size() == 1);
  REQUIRE(found[0].size() == 61);
  // The solution is sin(t + pi/4); scales follow from two points far apart.
  const auto y = [](std::size_t k) { return std::sin(0.1 * static_cast<double>(k) + M_PI / 4); };
  const auto [x0, high] = found[0][8];
  const auto [x1, low] = found[0][39];
  const double along = (x1 - x0) / 31, up = (high - low) / (y(8) - y(39));
  CHECK(along > 5);
  CHECK(up < -100);
  for (std::size_t k = 0; k <= 60; ++k) {
    CAPTURE(k);
    CHECK(std::abs(found[0][k].first - x0 - along * (static_cast<double>(k) - 8)) < 0.05);
    CHECK(std::abs(found[0][k].second - high - up * (y(k) - y(8))) < 0.05);
  }
  for (const char* text : {">A system<", ">prothero_robinson, rodas_5p<", ">Variables<", ">time<", ">y[0]<"}) {
    CAPTURE(text);
    CHECK(has(svg, text));
  }
}

TEST_CASE("variables too small to be seen have a picture of their own beside that of all",
          "[cli][plot][system][slow]") {
  const std::string svg =
      picture_of(scene_of("type = \"robertson\"\n", "until = 40\n[[every]]\ntype = \"trajectory\"\nevery = 0.5\n"));
  if (svg.empty()) return;
  CHECK(has(svg, ">Small variables<"));
  CHECK(lines(svg, colours[0]).size() == 1);
  CHECK(lines(svg, colours[2]).size() == 1);
  const auto b = lines(svg, colours[1]);  // 3.6e-5 at most, where A begins with 1
  REQUIRE(b.size() == 2);
  CHECK(height_of(b[0]) < 1);
  CHECK(height_of(b[1]) > 200);
  for (const char* name : {">A<", ">B<", ">C<"}) CHECK(has(svg, name));
}

TEST_CASE("of many variables plot shows eight, the first and the last among them", "[cli][plot][system][slow]") {
  const std::string svg = picture_of(scene_of("type = \"heat_line\"\npoints = 100\nleft = 1\nmode = 2\n",
                                              "until = 0.2\n[[every]]\ntype = \"trajectory\"\nevery = 0.01\n"));
  if (svg.empty()) return;
  CHECK_FALSE(has(svg, "Small variables"));
  for (const int k : {0, 14, 28, 42, 56, 70, 84, 99}) CHECK(has(svg, fmt::format(">y[{}]<", k)));
  CHECK_FALSE(has(svg, ">y[1]<"));
}

TEST_CASE("plot says what a system's run without frames lacks", "[cli][plot][system]") {
  const SceneFolder folder(
      scene_of("type = \"lorenz\"\n", "until = 1\n[[every]]\ntype = \"variables\"\nvariable = \"z\"\nevery = 0.1\n"));
  output(folder, "run scene.toml --quiet");
  const ProcessResult result = noether(folder, "plot scene.out/run.h5");
  CHECK(result.exit_code == 2);
  CHECK(result.err == "scene.out/run.h5 has nothing to draw; it needs frames (a trajectory writer)\n");
}

}  // namespace
}  // namespace noether::test

#endif

// Pictures of ensembles: which figure of which member is where, in which color.

#include "cli/plot_data.hpp"
#include "cli/plot_script.hpp"
#include "scene/parts.hpp"
#include "tests/cli/support.hpp"
#include "tests/ensemble/support.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace noether::test {
namespace {

/// A map of five times four members, of which those with an eccentricity of 1.05 are refused.
io::EnsembleTable map_of_planets(const ScratchFolder& folder) {
  write_text(folder / "scene.toml", planets());
  return rows_of(folder, plan_of({"particles.body.c.a=1.2:1.8:5", "particles.body.c.e=0:1.05:4"}), "map.h5");
}

double value_of(const io::EnsembleTable& table, const io::EnsembleRow& row, const std::string& column, Index place) {
  std::size_t at = table.definition.keys.size();
  for (const io::EnsembleColumn& one : table.definition.columns) {
    if (one.name == column) return row.values[at + static_cast<std::size_t>(place)];
    at += static_cast<std::size_t>(one.width());
  }
  return NAN;
}

std::string plot_refusal(const ScratchFolder& folder, const PlotOptions& options) {
  try {
    read_plot_data(folder / "map.h5", standard_parts(), options);
  } catch (const Error& error) {
    return error.message();
  }
  return "";
}

TEST_CASE("a map has each member's figure in its cell, and none where a member was refused", "[cli][ensemble][plot]") {
  const ScratchFolder folder;
  const io::EnsembleTable table = map_of_planets(folder);
  const PlotData data =
      read_plot_data(folder / "map.h5", standard_parts(), {.what = {"energy_worst", "elements_value.c.e", "time"}});
  REQUIRE(data.panels.size() == 3);
  const std::pair<std::string, Index> columns[] = {{"energy_worst", 0}, {"elements_value", 2 * 6 + 1}};
  for (std::size_t k = 0; k < 2; ++k) {
    const PlotPanel& panel = data.panels[k];
    INFO(panel.colors->scale.label);
    CHECK(panel.large);
    REQUIRE(panel.colors);
    CHECK(panel.colors->cells);
    CHECK(panel.x.label == "a of c");
    CHECK(panel.y.label == "e of c");
    // Up to the edges of the outermost cells.
    CHECK(std::abs(panel.x.low - 1.125) <= 1e-12);
    CHECK(std::abs(panel.x.high - 1.875) <= 1e-12);
    const std::vector<PlotPoint>& cells = panel.curves.at(0).points;
    REQUIRE(cells.size() == table.rows.size());
    for (const io::EnsembleRow& row : table.rows) {
      const auto cell = std::find_if(cells.begin(), cells.end(), [&](const PlotPoint& one) {
        return one.x == row.values[0] && one.y == row.values[1];
      });
      REQUIRE(cell != cells.end());
      const double drawn = panel.colors->values[static_cast<std::size_t>(cell - cells.begin())];
      const double told = value_of(table, row, columns[k].first, columns[k].second);
      CHECK(std::isnan(drawn) == (row.values[1] > 1));
      if (row.values[1] < 1) CHECK(drawn == told);
    }
  }
  CHECK(data.panels[2].colors->scale.label == "time at the end");
  const std::string script = plot_script(data, PictureFormat::svg, "map.svg");
  CHECK(has(script, "$c0 using 1:2:3 with image"));
  CHECK(has(script, "set cblabel 'elements value.c.e'"));
}

TEST_CASE("draws are points, and one key is an axis", "[cli][ensemble][plot]") {
  const ScratchFolder folder;
  write_text(folder / "scene.toml", planets());
  rows_of(folder, plan_of({"particles.body.c.a=uniform(1.5,1.8)", "particles.body.c.e=uniform(0,0.1)"}, 7), "map.h5");
  const PlotData points = read_plot_data(folder / "map.h5", standard_parts());
  REQUIRE(points.panels.size() == 1);
  CHECK_FALSE(points.panels[0].colors->cells);
  CHECK(points.panels[0].curves[0].points.size() == 7);
  CHECK(has(points.panels[0].colors->scale.label, "energy worst"));
  rows_of(folder, plan_of({"particles.body.c.a=1.5:1.8:6"}), "line.h5");
  const PlotData line = read_plot_data(folder / "line.h5", standard_parts(), {.what = {"position.b.x"}});
  CHECK_FALSE(line.panels.at(0).colors);
  CHECK(line.panels[0].curves[0].points.size() == 6);
  CHECK(line.panels[0].y.label == "position.b.x");
  CHECK(has(plot_script(line, PictureFormat::svg, "line.svg"), "with points pt 7"));
}

TEST_CASE("of grids with draws at each point a map has the mean", "[cli][ensemble][plot]") {
  const ScratchFolder folder;
  write_text(folder / "scene.toml", planets());
  const io::EnsembleTable table = rows_of(
      folder,
      plan_of({"particles.body.c.a=1.5:1.8:2", "particles.body.c.e=0:0.1:2", "particles.body.c.M=uniform(0,6)"}, 3),
      "map.h5");
  const PlotData data = read_plot_data(folder / "map.h5", standard_parts(), {.what = {"energy_rms"}});
  REQUIRE(data.panels.at(0).colors->values.size() == 4);
  double mean = 0;
  for (std::size_t k = 0; k < 3; ++k) mean += value_of(table, table.rows[k], "energy_rms", 0) / 3;
  CHECK(std::abs(data.panels[0].colors->values[0] - mean) <= 1e-15);
}

TEST_CASE("what a picture of an ensemble cannot show is refused in a line", "[cli][ensemble][plot]") {
  const ScratchFolder folder;
  map_of_planets(folder);
  CHECK(has(plot_refusal(folder, {.what = {"energy_wurst"}}), "did you mean 'energy_worst'?"));
  CHECK(has(plot_refusal(folder, {.what = {"elements_value.d"}}), "there is no 'd'; one of Sun, b, c is expected"));
  CHECK(has(plot_refusal(folder, {.what = {"energy_worst.b"}}), "energy_worst has 0 places after its name at most"));
  CHECK(has(plot_refusal(folder, {.frame = 1}), "leave out --frame"));
  CHECK(has(plot_refusal(folder, {.projection = "xy"}), "leave out --projection"));
}

}  // namespace
}  // namespace noether::test

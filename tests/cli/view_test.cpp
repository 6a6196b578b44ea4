// `noether view`: the page holds the frames of the run to its stated precision, needs nothing from outside, and shows
// in a browser what the run has.

#include "tests/cli/support.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>

#if NOETHER_HDF5

namespace noether::test {
namespace {

/// A crystal of 32 atoms in a periodic box, warm enough that some cross its walls.
const std::string small_melt = R"(title = "A <small> melt & more"
units = "reduced"
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
steps = 200
[[every]]
type = "energy"
steps = 10
[[every]]
type = "trajectory"
steps = 10
)";

/// What tests/io/view_page.py says of a page beside its run.
std::optional<std::string> page_beside_run(const ScratchFolder& folder, const std::string& page) {
  return python_output("view_page.py", {"frames", (folder / page).string(), (folder / "scene.out/run.h5").string()});
}

double number_at(const std::string& json, const std::string& key) { return std::stod(json_member(json, key)); }

}  // namespace

TEST_CASE("a page holds the frames of open space to the precision of a float", "[cli][view]") {
  const SceneFolder folder;
  output(folder, "run scene.toml --quiet");
  CHECK(output(folder, "view scene.out/run.h5") == "scene.out/run.html\n");
  const auto seen = page_beside_run(folder, "scene.out/run.html");
  if (!seen) return;
  CHECK(number_at(*seen, "position") < 1.2e-7);
  CHECK(number_at(*seen, "velocity") < 1.2e-7);
  CHECK(number_at(*seen, "time") == 0);
  CHECK(number_at(*seen, "frames") == 6);
  CHECK(number_at(*seen, "energies") == 11);
  CHECK(has(*seen, "\"paths\":[\"smooth\",\"arcs\"]"));  // the heavy body, and what orbits it
}

TEST_CASE("frames with a number that is not finite are left out, and that is told", "[cli][view]") {
  const SceneFolder folder(small_melt);
  output(folder, "run scene.toml --quiet");
  const auto spoil = [&](const std::string& rows) {
    const std::string code =
        "import h5py; f = h5py.File('scene.out/run.h5', 'r+'); "
        "f['/particles/system/position/value'][" +
        rows + ", 3, 0] = float('nan')";
    return run_process({NOETHER_PYTHON, "-c", code}, folder.path()).exit_code == 0;
  };
  if (std::string(NOETHER_PYTHON).empty() || !spoil("4:6")) {
    WARN("there is no Python with h5py: the frames are not spoiled");
    return;
  }
  const ProcessResult some = noether(folder, "view scene.out/run.h5 --json");
  CHECK(some.exit_code == 0);
  CHECK(json_member(some.out, "frames") == "19");
  CHECK(some.err == "19 of 21 frames are shown\n2 frames are left out, because a number in them is not finite\n");
  REQUIRE(spoil(":"));
  const ProcessResult none = noether(folder, "view scene.out/run.h5");
  CHECK(none.exit_code == 3);
  CHECK(none.err == "scene.out/run.h5: there is no frame to view: in each of them a number is not finite\n");
}

TEST_CASE("a page holds the frames of a periodic box to half of 2^-16 of its edge", "[cli][view]") {
  const SceneFolder folder(small_melt);
  output(folder, "run scene.toml --quiet");
  const std::string report = output(folder, "view scene.out/run.h5 --out page.html --json");
  CHECK(json_member(report, "schema") == "\"noether.view/1\"");
  CHECK(json_member(report, "frames") == "21");
  CHECK(json_member(report, "particles") == "32");
  const auto seen = page_beside_run(folder, "page.html");
  if (!seen) return;
  CHECK(number_at(*seen, "position") <= 0.5 + 1e-6);  // in units of 2^-16
  CHECK(number_at(*seen, "position") > 0.1);
}

TEST_CASE("a page needs nothing from outside, and text of a scene cannot leave its place", "[cli][view]") {
  const SceneFolder folder(small_melt);
  output(folder, "run scene.toml --quiet");
  output(folder, "view scene.out/run.h5 --out page.html");
  const std::string page = read_text(folder / "page.html");
  for (const char* outside : {"http:", "https:", "src=", "@import", "url(", "fetch(", "XMLHttpRequest"}) {
    INFO(outside);
    CHECK_FALSE(has(page, outside));
  }
  CHECK(has(page, "<title>A &lt;small&gt; melt &amp; more</title>"));
  CHECK(has(page, "\"title\":\"A \\u003csmall> melt & more\""));
}

TEST_CASE("frames that are not shown are told in one line", "[cli][view]") {
  const SceneFolder folder;
  output(folder, "run scene.toml --quiet");
  for (const auto& [option, shown] :
       {std::pair("--frames 3", 3), std::pair("--every 4", 2), std::pair("--frames 1", 1)}) {
    INFO(option);
    const ProcessResult some = noether(folder, fmt::format("view scene.out/run.h5 --out some.html {}", option));
    CHECK(some.exit_code == 0);
    CHECK(some.out == "some.html\n");
    CHECK(some.err == fmt::format("{} of 6 frames are shown\n", shown));
  }
  CHECK(noether(folder, "view scene.out/run.h5 --frames 900").err.empty());
}

TEST_CASE("what view cannot show is refused in one line with what to do", "[cli][view][messages]") {
  const SceneFolder folder;
  output(folder, "run scene.toml --quiet");
  const auto refused = [&](const std::string& line, int code, const std::string& message) {
    const ProcessResult result = noether(folder, line);
    INFO(line);
    CHECK(result.exit_code == code);
    CHECK(result.err == message + "\n");
  };
  refused("view nothing.h5", 3, "nothing.h5: there is no such file");
  refused("view scene.out/run.h5 --out page.png", 2,
          "a page 'page.png' does not end in .html; did you mean 'page.html'?");
  refused("view scene.out/checkpoint.h5", 2,
          "scene.out/checkpoint.h5 is a checkpoint, which holds one moment; view the run.h5 beside it");
  refused("view scene.out/run.h5 --out nowhere/page.html", 3, "nowhere/page.html: the page could not be written");
  write_text(folder / "scene.toml",
             "units = \"reduced\"\n[system]\ntype = \"lorenz\"\n[integrator]\nmethod = \"rk4\"\nstep = 0.01\nsteps = "
             "10\n[[every]]\ntype = \"trajectory\"\nsteps = 1\n");
  output(folder, "run scene.toml --quiet --fresh");
  refused("view scene.out/run.h5", 2,
          "scene.out/run.h5 is the run of a [system], which has no particles; `noether plot scene.out/run.h5` draws "
          "its variables");
}

TEST_CASE("a run.h5 that was cut short is refused as by plot", "[cli][view][lost]") {
  const SceneFolder folder;
  output(folder, "run scene.toml --quiet");
  write_text(folder / "cut.h5", read_text(folder / "scene.out/run.h5").substr(0, 3000));
  const ProcessResult plot = noether(folder, "plot cut.h5"), view = noether(folder, "view cut.h5");
  CHECK(view.exit_code == 3);
  CHECK(view.err == plot.err);
}

// A browser takes seconds to start.
TEST_CASE("in a browser, planets have trails and names, and a melt has its box and all of its atoms",
          "[cli][view][nightly]") {
  const SceneFolder folder;
  output(folder, "run scene.toml --quiet");
  output(folder, "view scene.out/run.h5 --out planets.html");
  const auto planets = python_output("view_page.py", {"shot", (folder / "planets.html").string(), "frame=3&paused"});
  if (!planets) return;
  INFO(*planets);
  CHECK(json_member(*planets, "frame") == "\"3\"");
  CHECK(json_member(*planets, "points") == "\"2\"");
  CHECK(json_member(*planets, "trails") == "\"1\"");
  CHECK(json_member(*planets, "labels") == "\"2\"");
  CHECK(json_member(*planets, "box") == "\"0\"");
  CHECK(number_at(*planets, "wide") > 0.3);  // the ellipse fills the picture
  CHECK(number_at(*planets, "hues") >= 1);

  const SceneFolder box(small_melt);
  output(box, "run scene.toml --quiet");
  output(box, "view scene.out/run.h5 --out melt.html");
  const auto melt = python_output("view_page.py", {"shot", (box / "melt.html").string(), "frame=20&paused"});
  REQUIRE(melt);
  INFO(*melt);
  CHECK(json_member(*melt, "frame") == "\"20\"");
  CHECK(json_member(*melt, "points") == "\"32\"");
  CHECK(json_member(*melt, "trails") == "\"0\"");
  CHECK(json_member(*melt, "box") == "\"12\"");
  CHECK(json_member(*melt, "labels") == "\"0\"");
  CHECK(number_at(*melt, "hues") >= 2);  // from blue to red
  CHECK(number_at(*melt, "lit") > 4000);
  CHECK(number_at(*melt, "lit") > 3 * number_at(*planets, "lit"));
}

}  // namespace noether::test

#endif

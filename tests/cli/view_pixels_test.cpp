// Pages of long runs in a browser: what is counted in the pixels of the screenshots is what the run has. What a page
// says of itself counts for nothing here.

#include "tests/cli/support.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>

#if NOETHER_HDF5

namespace noether::test {
namespace {

const std::filesystem::path examples_folder = NOETHER_SOURCE_DIR "/examples";

double counted_in(const std::string& json, const std::string& key) { return std::stod(json_member(json, key)); }

/// What tests/io/view_page.py finds in the screenshot of a page beside the run it shows.
std::optional<std::string> pixels_of(const std::string& what, const ScratchFolder& folder, const std::string& page,
                                     const std::string& moment) {
  return python_output("view_page.py", {what, (folder / page).string(), (folder / "scene.out/run.h5").string(),
                                        moment + "&paused&names=off&trails=none&box=off"});
}

/// A frame of bodies about a primary: as many spots as there are bodies in the picture, each in its place and color.
void check_bodies(const ScratchFolder& folder, const std::string& moment, double least) {
  const auto seen = pixels_of("bodies", folder, "page.html", moment);
  if (!seen) return;
  INFO(moment << ": " << *seen);
  CHECK(counted_in(*seen, "expected") >= least);
  CHECK(counted_in(*seen, "spots") == counted_in(*seen, "expected"));  // each body has a spot of its own
  CHECK(counted_in(*seen, "primary") >= 1);
  CHECK(counted_in(*seen, "off") < 4);
  CHECK(counted_in(*seen, "hue") < 0.06);
}

/// The Solar System with frames in which Mercury is seen four times a period. @param sign  of the step
std::string solar_system(int frames, int sign) {
  return fmt::format(
      "title = \"Solar system\"\nunits = \"solar\"\n[particles]\nbodies = \"planets.csv\"\nframe = \"barycenter\"\n"
      "[hamiltonian]\ntype = \"wisdom_holman\"\n[integrator]\nmethod = \"aba_10_6_4\"\nstep = \"{} day\"\nsteps = {}\n"
      "[[every]]\ntype = \"trajectory\"\nsteps = 5\n",
      4 * sign, 5 * frames);
}

TEST_CASE("a thousand frames of the Solar System show its bodies in their places and colors", "[cli][view][nightly]") {
  for (const int sign : {1, -1}) {  // back in time too
    CAPTURE(sign);
    const SceneFolder folder(solar_system(1000, sign));
    std::filesystem::copy(examples_folder / "solar_system/planets.csv", folder.path());
    output(folder, "run scene.toml --quiet");
    const std::string report = output(folder, "view scene.out/run.h5 --out page.html --json");
    CHECK(json_member(report, "frames") == "1001");
    check_bodies(folder, "frame=0", 4);            // the light of the Sun hides the inner planets
    check_bodies(folder, "frame=1000", 3);         // that light may hide Jupiter too
    check_bodies(folder, "frame=700&zoom=16", 4);  // the inner planets
  }
}

TEST_CASE("a thousand frames of a melt of 4000 atoms show their discs, in the colors of where they were",
          "[cli][view][nightly]") {
  const SceneFolder folder(read_text(examples_folder / "lj_melt/scene.toml"));
  std::string scene = read_text(folder / "scene.toml");
  const std::size_t every = scene.rfind("steps = 500");
  REQUIRE(every != std::string::npos);
  write_text(folder / "scene.toml", scene.replace(every, 11, "steps = 2"));
  output(folder, "run scene.toml --quiet");
  const std::string report = output(folder, "view scene.out/run.h5 --out page.html --json");
  CHECK(json_member(report, "frames") == "1001");
  CHECK(json_member(report, "particles") == "4000");
  for (const char* moment : {"frame=0", "frame=500", "frame=1000"}) {
    const auto seen = pixels_of("atoms", folder, "page.html", moment);
    if (!seen) return;
    INFO(moment << ": " << *seen);
    CHECK(counted_in(*seen, "fit") > 0.85);  // most lit pixels are those of discs of atoms, and most of these are lit
    CHECK(counted_in(*seen, "wide") > 0.3);
    CHECK(counted_in(*seen, "wide") < 0.5);
    CHECK(counted_in(*seen, "share") > 0.2);
    CHECK(counted_in(*seen, "share") < 0.35);
    CHECK(counted_in(*seen, "colors") > 0.8);  // from blue to orange, as the atoms stood at first
    CHECK(counted_in(*seen, "warm") > 0.2);
    CHECK(counted_in(*seen, "cold") > 0.15);
  }
}

TEST_CASE("a page of 200 001 frames opens and shows each of them", "[cli][view][nightly]") {
  const SceneFolder folder(
      "title = \"Planets without mass\"\nunits = \"reduced\"\n[particles]\nbody = [{ name = \"Sun\", mass = 1, x = [0, "
      "0, "
      "0], v = [0, 0, 0] }, { name = \"Earth\", mass = 0, x = [1, 0, 0], v = [0, 1, 0] }, { name = \"Mars\", mass = 0, "
      "x = "
      "[0, 2, 0], v = [-0.7, 0, 0.1] }]\n[hamiltonian]\ntype = \"kinetic_potential\"\n[[hamiltonian.force]]\ntype = "
      "\"gravity\"\n[integrator]\nmethod = \"verlet\"\nstep = 0.01\nsteps = 200000\n[[every]]\ntype = "
      "\"trajectory\"\nsteps = 1\n");
  output(folder, "run scene.toml --quiet");
  const std::string report = output(folder, "view scene.out/run.h5 --out page.html --json");
  CHECK(json_member(report, "frames") == "200001");
  for (const char* moment : {"frame=0", "frame=123456", "frame=200000"}) check_bodies(folder, moment, 2);
}

}  // namespace
}  // namespace noether::test

#endif

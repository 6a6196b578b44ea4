/// Fields on grids in scenes: their files, and what is told of them.

#include "scene/grid_files.hpp"
#include "forces/electromagnetic_fields.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"

#include "io/hdf5_file.hpp"

#include <fstream>
#include <string>

#if NOETHER_HDF5

namespace noether::test {
namespace {

const char* const scene_text = R"(units = "reduced"
[[particles.body]]
name = "ion"
mass = 1
charge = 1
x = [0.1, 0, 0]
v = [0, 0.1, 0.02]
[hamiltonian]
type = "charged_particles"
[[hamiltonian.field]]
type = "field_grid"
file = "coils.h5"
[integrator]
method = "verlet_aba"
step = 0.1
steps = 20
)";

FieldGrid coils(bool B_alone) {
  FieldGrid grid = FieldGrid::of(MagneticMirror{.B0 = 2, .radius = 2, .distance = 3}, {12, 12, 12}, {-1.1, -1.1, -1.1},
                                 {0.2, 0.2, 0.2});
  if (B_alone) {
    grid.B = grid.A;
    grid.A.clear();
  }
  return grid;
}

Scene load(const ScratchFolder& folder) {
  write_text(folder.path() / "scene.toml", scene_text);
  return load_scene(folder.path() / "scene.toml", standard_parts());
}

}  // namespace

TEST_CASE("a scene reads its grid beside it", "[scene][grid_files]") {
  const ScratchFolder folder;
  write_field_grid(folder.path() / "coils.h5", coils(false));
  const Scene scene = load(folder);
  CHECK(scene.notes.empty());
  Simulation<double> sim = assemble(scene);
  CHECK(sim.run(20).ok());
  const GridField direct{.file = "", .grid = std::make_shared<const FieldGrid>(coils(false))};
  CHECK(scene.hamiltonian.forces.front().force.signature() == direct.signature());
}

TEST_CASE("of B alone the divergence is told", "[scene][grid_files]") {
  const ScratchFolder folder;
  write_field_grid(folder.path() / "coils.h5", coils(true));
  const Scene scene = load(folder);
  REQUIRE(scene.notes.size() == 1);
  CHECK_THAT(scene.notes.front(), Catch::Contains("B alone") && Catch::Contains("div B"));
}

TEST_CASE("files that hold no grid are refused with what they lack", "[scene][grid_files]") {
  const ScratchFolder folder;
  const auto message = [&] {
    try {
      load(folder);
    } catch (const Error& error) {
      CHECK(error.line() == 12);
      return error.message();
    }
    return std::string("taken");
  };
  CHECK_THAT(message(), Catch::Contains("coils.h5"));
  const auto with = [&](const auto& fill) {
    const io::Hdf5File file = io::Hdf5File::create(folder.path() / "coils.h5");
    fill(file);
    file.take_name();
  };
  const std::vector<double> three = {1, 1, 1}, few(3 * 5 * 6 * 6, 0.0);
  with([&](const io::Hdf5File& file) { file.write("/origin", std::span<const double>(three), {3}); });
  CHECK_THAT(message(), Catch::Contains("has no dataset 'spacing'"));
  with([&](const io::Hdf5File& file) {
    file.write("/origin", std::span<const double>(three), {3});
    file.write("/spacing", std::span<const double>(three), {3});
  });
  CHECK_THAT(message(), Catch::Contains("too small"));
  with([&](const io::Hdf5File& file) {
    file.write("/origin", std::span<const double>(three), {3});
    file.write("/spacing", std::span<const double>(three), {3});
    file.write("/A", std::span<const double>(few), {5, 6, 6, 3});
  });
  CHECK_THAT(message(), Catch::Contains("5 x 6 x 6"));
  with([&](const io::Hdf5File& file) {
    file.write("/origin", std::span<const double>(three), {3});
    file.write("/spacing", std::span<const double>(three), {3});
    file.write("/A", std::span<const double>(few), {5, 18, 6});
  });
  CHECK_THAT(message(), Catch::Contains("[nx, ny, nz, 3] is expected"));
}

}  // namespace noether::test

#endif

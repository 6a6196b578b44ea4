// Meshes in run.h5, back to the bit, and as grids for ParaView.

#include "engine/mesh.hpp"
#include "io/frame_particles.hpp"
#include "io/hdf5_file.hpp"
#include "io/inspect.hpp"
#include "io/trajectory.hpp"
#include "scene/block.hpp"
#include "tests/io/support.hpp"

#if NOETHER_HDF5

namespace noether::test {
namespace {

ParticleSystem<double> small_block() {
  ParticleSystem<double> s =
      Block{.cells = {1, 1, 2}, .size = {1, 1, 2.0 / 3}, .density = 3, .stretch = {2, 1, 1}}.build();
  std::vector<std::int64_t> ids = s.ids();  // in no order
  std::swap(ids[0], ids[5]);
  std::swap(ids[2], ids[11]);
  s.restore_ids(ids);
  return s;
}

}  // namespace

TEST_CASE("a mesh in run.h5 comes back to the bit, its edges stand where VMD looks", "[trajectory][mesh]") {
  const ScratchFolder folder;
  const ParticleSystem<double> s = small_block();
  io::write_one_frame(folder / "run.h5", s, 3, 0.25);
  const io::FrameParticles back = io::read_frame_particles(folder / "run.h5");
  const Mesh &one = *s.topology()->mesh, &other = *back.particles.topology()->mesh;
  CHECK(back.particles.ids() == s.ids());
  CHECK(one.rest == other.rest);
  CHECK(one.tetrahedra == other.tetrahedra);
  CHECK(one.triangles == other.triangles);
  CHECK(one.regions == other.regions);
  CHECK(one.surfaces == other.surfaces);
  const io::Hdf5File file = io::Hdf5File::open_to_read(folder / "run.h5");
  const auto from = file.open("/parameters/vmd_structure/bond_from").read_integers();
  const auto to = file.open("/parameters/vmd_structure/bond_to").read_integers();
  REQUIRE(from.size() == one.edges().size());
  CHECK(to.size() == from.size());
  CHECK(*std::min_element(from.begin(), from.end()) >= 1);
  CHECK(*std::max_element(to.begin(), to.end()) <= s.size());
}

TEST_CASE("a grid for ParaView has the points, cells and ratios of volumes of a frame", "[convert][mesh]") {
  const ScratchFolder folder;
  io::write_one_frame(folder / "run.h5", small_block(), 3, 0.25);
  CHECK(io::convert(folder / "run.h5", folder / "block.vtu", {}) == 1);
  const std::string text = read_text(folder / "block.vtu");
  CHECK_THAT(text, Catch::Contains("NumberOfPoints=\"12\" NumberOfCells=\"12\""));
  CHECK_THAT(text, Catch::Contains("Name=\"volume_ratio\" NumberOfComponents=\"1\" format=\"ascii\">\n2\n2"));
  CHECK_THAT(text, Catch::Contains("10 10 10"));
  CHECK(text.ends_with("</VTKFile>\n"));
}

TEST_CASE("several frames become files of their own, with a list of their times", "[convert][mesh]") {
  const ScratchFolder folder;
  {
    Simulation<double> sim(small_block(), compose(kinetic_potential(), schemes::verlet), 0.125);
    auto& writer = sim.every(1, io::TrajectoryWriter(folder / "run.h5"));
    REQUIRE(sim.run(2).ok());
    writer.finish(Outcome{});
  }
  CHECK(io::convert(folder / "run.h5", folder / "out.vtu", {}) == 3);
  CHECK_FALSE(std::filesystem::exists(folder / "out.vtu"));
  CHECK(std::filesystem::exists(folder / "out_0002.vtu"));
  CHECK_THAT(read_text(folder / "out.pvd"), Catch::Contains("timestep=\"0.25\" file=\"out_0002.vtu\""));
}

}  // namespace noether::test

#endif

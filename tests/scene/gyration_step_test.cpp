/// Steps told by how long a charge takes to turn, against 2 pi m gamma/(q B).

#include "engine/simulation.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

namespace noether::test {
namespace {

/// An atom without charge, and one of charge 1 and mass 4 in a field of 2 along z.
Scene scene_of(const std::string& hamiltonian, const std::string& step) {
  const ScratchFolder folder;
  write_text(folder.path() / "scene.toml", fmt::format(R"(units = "reduced"
[[particles.body]]
name = "atom"
mass = 1
charge = 0
x = [5, 0, 0]
v = [0, 0, 0]
[[particles.body]]
name = "ion"
mass = 4
charge = 1
x = [0, 0, 0]
v = [3, 0, 0]
[hamiltonian]
type = "charged_particles"
{}
[[hamiltonian.field]]
type = "uniform_electromagnetic"
B = [0, 0, 2]
[integrator]
method = "verlet_aba"
step = {}
steps = 20
)",
                                                       hamiltonian, step));
  return load_scene(folder.path() / "scene.toml", standard_parts());
}

}  // namespace

TEST_CASE("a step of a part of a gyration is that part of the turn of the first charge that turns",
          "[scene][charges]") {
  const double turn = 2 * std::numbers::pi * 4 / 2;
  CHECK(scene_of("", "\"0.05 gyration\"").integrator.step == 0.05 * turn);
  CHECK(scene_of("", "\"gyration\"").integrator.step == turn);
  // c = 5: gamma = 1/sqrt(1 - (3/5)^2) = 5/4
  const double fast = scene_of("relativistic = \"boris\"\nc = 5", "\"0.05 gyration\"").integrator.step;
  CHECK(std::abs(fast / (0.05 * turn * 1.25) - 1) <= 1e-15);
}

TEST_CASE("twenty steps of a twentieth of a gyration are a turn", "[scene][charges]") {
  Simulation<double> sim = assemble(scene_of("", "\"0.05 gyration\""));
  REQUIRE(sim.run(20).ok());
  CHECK((Vec3<double>(sim.particles().velocities()[1]) - Vec3<double>(3, 0, 0)).norm() <= 1e-14);
  CHECK(Vec3<double>(sim.particles().positions()[1]).norm() <= 1e-13);
}

}  // namespace noether::test

// What steps of a shearing sheet have to resolve, against numbers found by hand.

#include "study/sheet_steps.hpp"
#include "study/kepler_steps.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>
#include <string>

namespace noether::test {
namespace {

constexpr double pi = std::numbers::pi;

/// Two spheres of a sheet of Omega = 0.5 at heights 0, the second with u = (0.3, 0.4, 0) about the shear.
Scene two_spheres(const std::string& forces, const std::string& method = "verlet") {
  return read_scene(
      "units = 'reduced'\n[[particles.body]]\nname = 'still'\nmass = 2\nradius = 0.5\nx = [0, 0, 0]\nv = [0, 0, 0]\n"
      "[[particles.body]]\nname = 'swift'\nmass = 1e-3\nradius = 0.25\nx = [2, 3, 0]\nv = [0.3, -1.1, 0]\n"
      "[hamiltonian]\ntype = 'shearing_sheet'\nOmega = 0.5\n[[hamiltonian.force]]\ntype = 'hard_spheres'\n"
      "restitution = 0.5\n" +
          forces + "[integrator]\nmethod = '" + method + "'\nstep = 0.01\nsteps = 1\n",
      "scene.toml");
}

std::string gravity(const std::string& G) { return "[[hamiltonian.force]]\ntype = 'gravity'\nG = " + G + "\n"; }

TEST_CASE("steps of a sheet are told by its turn, by surfaces and by what spheres cross", "[sheet_steps]") {
  const auto free = sheet_steps(two_spheres(""));
  REQUIRE(free);
  CHECK_FALSE(free->recommended());
  CHECK(free->reason() == "no force acts, and epicycles and contacts are exact at any step");
  CHECK(std::abs(free->turn - 4 * pi) < 1e-14);

  // At the surface of 'still' 2 pi sqrt(0.125/(2 G)); 'swift' goes 0.5 in its diameter of 0.5.
  const auto weak = sheet_steps(two_spheres(gravity("1e-6")));
  REQUIRE(weak);
  CHECK(weak->surface_of == "still");
  CHECK(std::abs(weak->surface - 2 * pi * std::sqrt(0.0625 / 1e-6)) < 1e-9);
  CHECK(weak->crossing_of == "swift");
  CHECK(std::abs(weak->crossing - 1) < 1e-14);
  CHECK(std::abs(weak->recommended().value() - 4 * pi / 100) < 1e-14);
  CHECK(weak->reason() == "a hundredth of a turn of the frame");

  const auto strong = sheet_steps(two_spheres(gravity("1")));
  REQUIRE(strong);
  CHECK(std::abs(strong->recommended().value() - 2 * pi * 0.25 / 20) < 1e-14);
  CHECK(strong->reason() == "a twentieth of a turn about still at its surface");

  Scene swift = two_spheres(gravity("1"));
  swift.particles.velocities().set(1, {30, 38.5, 0});
  CHECK(std::abs(sheet_steps(swift)->recommended().value() - 0.25 / 50) < 1e-14);
  CHECK(sheet_steps(swift)->reason() == "in which swift goes as far as its radius");

  const Scene plain = read_scene(
      "units = 'reduced'\n[[particles.body]]\nmass = 1\nx = [0, 0, 0]\nv = [0, 0, 0]\n[[particles.body]]\nmass = 0\n"
      "x = [1, 0, 0]\nv = [0, 1, 0]\n[hamiltonian]\ntype = 'kinetic_potential'\n" +
          gravity("1") + "[integrator]\nmethod = 'verlet'\nstep = 0.01\nsteps = 1\n",
      "scene.toml");
  CHECK_FALSE(sheet_steps(plain));
  CHECK(kepler_steps(plain));
}

}  // namespace
}  // namespace noether::test

// Minimization as scenes ask for it: along constraints, and about bodies that are held.

#include "scene/minimize.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/settings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace noether::test {
namespace {

double distance(const ParticleSystem<double>& s, Index i, Index j) {
  return std::sqrt(norm2(s.box().minimum_image(Vec3<double>(s.positions()[i] - s.positions()[j]))));
}

std::string body(const std::string& name, double mass, const Vec3<double>& x) {
  return fmt::format("[[particles.body]]\nname = '{}'\nmass = {}\nx = [{}, {}, {}]\nv = [0, 0, 0]\n", name, mass, x[0],
                     x[1], x[2]);
}

const std::string end = "[integrator]\nmethod = 'verlet'\nstep = 0.001\nsteps = 1\n";

}  // namespace

TEST_CASE("a pendulum of three links comes to hang straight down", "[scene][minimize]") {
  Scene scene =
      read_scene("units = 'reduced'\n" + body("top", 1, {0, 0, 0}) + body("a", 2, {1, 0, 0}) +
                     body("b", 0.5, {1.6, 0.8, 0}) + body("c", 3, {1.6, 0.8, 1.5}) +
                     "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'uniform_field'\n"
                     "acceleration = [0, 0, -9.81]\n[[hamiltonian.constraint]]\ntype = 'fixed'\nbodies = "
                     "['top']\n[[hamiltonian.constraint]]\ntype = 'distance'\nchain = ['top', "
                     "'c']\n[minimize]\nmax_force = 1e-9\nmax_displacement = 0.1\nsteps = 20000\n" +
                     end,
                 "scene.toml");
  const Minimized done = minimize_start(scene);
  CHECK(done.converged());
  const ParticleSystem<double>& s = scene.particles;
  CHECK(norm2(Vec3<double>(s.positions()[0])) == 0);
  double below = 0;
  const double links[] = {1, 1, 1.5};
  for (Index i = 1; i < 4; ++i) {
    below += links[i - 1];
    CHECK(std::abs(distance(s, i, i - 1) - links[i - 1]) < 1e-12);
    // A force of 1e-9 is left: it turns a link of tension T by 1e-9 / T.
    CHECK(std::abs(s.positions()[i][2] + below) < 1e-12);
    CHECK(std::hypot(s.positions()[i][0], s.positions()[i][1]) < 1e-9);
  }
}

TEST_CASE("an atom comes to rest beside one that is held", "[scene][minimize]") {
  for (const double r : {3.0, 0.9, 0.01}) {
    Scene scene =
        read_scene("units = 'reduced'\n" + body("held", 1, {0.25, 0.5, 0}) + body("free", 4, {0.25 + r, 0.5, 0}) +
                       "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = "
                       "'lennard_jones'\ncutoff = 8\nepsilon = 1\nsigma = 1\ncutoff_style = "
                       "'shifted'\n[[hamiltonian.constraint]]\ntype = 'fixed'\nbodies = "
                       "['held']\n[minimize]\nmax_force = 1e-9\n" +
                       end,
                   "scene.toml");
    CAPTURE(r);
    CHECK(minimize_start(scene).converged());
    CHECK(Vec3<double>(scene.particles.positions()[0]) == Vec3<double>(0.25, 0.5, 0));
    CHECK(std::abs(distance(scene.particles, 0, 1) - std::pow(2.0, 1.0 / 6)) < 1e-9);
  }
}

TEST_CASE("rigid dumbbells in a box relax to the same bits on any number of threads, however fast they move",
          "[scene][minimize][determinism]") {
  std::string bodies, pairs;
  for (int k = 0; k < 27; ++k) {
    const Vec3<double> x(0.4 + 1.5 * (k % 3), 0.4 + 1.5 * (k / 3 % 3), 0.4 + 1.5 * (k / 9));
    bodies += body(fmt::format("a{}", k), 1, x) +
              body(fmt::format("b{}", k), 2, x + 0.8 * Vec3<double>(k % 2 == 0, k % 2 == 1, 0));
    pairs += fmt::format("['a{}', 'b{}'],", k, k);
  }
  const auto relaxed = [&](int threads, double speed) {
    const Threads some(threads);
    Scene scene = read_scene("units = 'reduced'\n[particles]\nbox = [4.5, 4.5, 4.5]\n" + bodies +
                                 "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = "
                                 "'lennard_jones'\ncutoff = 2\nepsilon = 1\nsigma = "
                                 "0.8\n[[hamiltonian.constraint]]\ntype = 'distance'\npairs = [" +
                                 pairs + "]\n[minimize]\nmax_force = 1e-6\n" + end,
                             "scene.toml");
    VectorColumn<double>& v = scene.particles.velocities();
    for (Index i = 0; i < v.size(); ++i) v.set(i, speed * Vec3<double>(1, i % 3, i % 2 * i % 5));
    const Minimized done = minimize_start(scene);
    CHECK(done.converged());
    for (Index k = 0; k < 27; ++k) CHECK(std::abs(distance(scene.particles, 2 * k, 2 * k + 1) - 0.8) < 1e-12);
    return scene.particles;
  };
  const ParticleSystem<double> one = relaxed(1, 0), three = relaxed(3, 0), fast = relaxed(1, 10);
  for (Index i = 0; i < one.size(); ++i) {
    CHECK(one.positions()[i] == three.positions()[i]);
    CHECK(one.positions()[i] == fast.positions()[i]);
    CHECK(norm2(Vec3<double>(fast.velocities()[i])) > 1);
  }
}

}  // namespace noether::test

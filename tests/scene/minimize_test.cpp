// Minimization as scenes ask for it: along constraints, and about bodies that are held.

#include "scene/minimize.hpp"

#include "forces/sum.hpp"
#include "integrators/minimize.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/settings.hpp"

#include <Eigen/Geometry>

#include <fmt/format.h>

#include <cmath>
#include <optional>
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

/// SPC/E at 300 K; forces that end smoothly are those of a minimum.
Scene water(int molecules, const std::string& minimize, const std::string& solver = "'newton'") {
  return read_scene(
      fmt::format("units = 'molecular'\n[particles]\ntype = 'water_box'\nmodel = 'spce'\nmolecules = {}\n"
                  "density = '{} g/cm^3'\ntemperature = '300 K'\nseed = 5\n[hamiltonian]\ntype = "
                  "'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'lennard_jones'\ncutoff = '0.6 nm'\n"
                  "cutoff_style = 'switch_c4'\n[[hamiltonian.force]]\ntype = 'reaction_field'\ncutoff = "
                  "'0.6 nm'\n[[hamiltonian.constraint]]\ntype = 'rigid_molecules'\nsolver = {}\n[minimize]\n{}\n"
                  "[integrator]\nmethod = 'verlet'\nstep = '2 fs'\nsteps = 1\n",
                  molecules, molecules > 2 ? 0.997 : 0.02, solver, minimize),
      "scene.toml");
}

double energy_of(const Scene& scene, const ParticleSystem<double>& s) {
  ForceField<double> forces;
  for (const SceneForce& force : scene.hamiltonian.terms()) forces.add(force.force);
  forces.bind(s);
  VectorColumn<double> a(s.size());
  ForceSink<double> sink(a, s, {.energy = true});
  forces.add_to(sink, s);
  return sink.potential();
}

/// The energy where one molecule of water is turned about its oxygen by a vector [rad], then shifted [nm].
double energy_beside(const Scene& scene, Index oxygen, const Vec3<double>& shift, const Vec3<double>& turn) {
  ParticleSystem<double> s = scene.particles;
  const double angle = turn.norm();
  const Eigen::AngleAxisd rotation(angle, angle > 0 ? Eigen::Vector3d(turn / angle) : Eigen::Vector3d::UnitX());
  const Vec3<double> centre = s.unwrapped(oxygen);
  for (Index i = oxygen; i < oxygen + 3; ++i) {
    const Vec3<double> arm = s.unwrapped(i) - centre;
    s.shift(i, Vec3<double>(rotation * arm - arm + shift), Vec3<double>::Zero());
  }
  s.moved();
  return energy_of(scene, s);
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

TEST_CASE("rigid water at 300 K comes to a minimum: no molecule can be shifted or turned to less energy",
          "[scene][minimize]") {
  Scene scene = water(27, "max_force = '1e-5 kJ/mol/nm'");
  const double before = energy_of(scene, scene.particles);
  const ParticleSystem<double> start = scene.particles;
  const Minimized done = minimize_start(scene);
  CAPTURE(done.steps, done.force);
  REQUIRE(done.converged());
  CHECK(done.steps < 5000);
  const ParticleSystem<double>& s = scene.particles;
  CHECK(energy_of(scene, s) < before);
  for (Index i = 0; i < s.size(); ++i) CHECK(s.velocities()[i] == start.velocities()[i]);
  const double least = energy_of(scene, s);
  double slope = 0, curvature = 1e300;
  for (Index oxygen = 0; oxygen < s.size(); oxygen += 3) {
    CHECK(std::abs(distance(s, oxygen, oxygen + 1) - 0.1) < 1e-14);
    CHECK(std::abs(distance(s, oxygen + 1, oxygen + 2) - 0.2 * std::sin(109.47 * M_PI / 360)) < 1e-14);
    for (int k = 0; k < 6; ++k) {
      const Vec3<double> unit = Vec3<double>::Unit(k % 3), none = Vec3<double>::Zero();
      const auto at = [&](double x) {
        return energy_beside(scene, oxygen, k < 3 ? x * unit : none, k < 3 ? none : x * unit);
      };
      slope = std::max(slope, std::abs(at(1e-5) - at(-1e-5)) / 2e-5);
      curvature = std::min(curvature, (at(1e-4) + at(-1e-4) - 2 * least) / 1e-8);
    }
  }
  CAPTURE(slope, curvature);
  CHECK(slope < 1e-3);  // energies are sums of grains of 1e-10
  CHECK(curvature > 0);
}

TEST_CASE("a minimum is on the constraints to rounding, whatever the solver of the run leaves of them",
          "[scene][minimize]") {
  for (const std::string solver : {"'rattle'\ntolerance = 1e-4", "'p_shake'\ntolerance = 1e-3", "'lincs'\norder = 2"}) {
    Scene scene = water(27, "max_force = '500 kJ/mol/nm'", solver);
    CAPTURE(solver);
    CHECK(minimize_start(scene).converged());
    CHECK(constraints_of(scene).worst(scene.particles).residual < 1e-13);
    Simulation<double> sim = assemble(scene);
    CHECK(sim.run(1).ok());
  }
}

TEST_CASE("two molecules of rigid water come to one minimum by long steps and by short ones", "[scene][minimize]") {
  double energies[2], oxygens[2];
  for (const int k : {0, 1}) {
    Scene scene = water(2, k == 0 ? "max_force = '1e-6 kJ/mol/nm'\nmax_displacement = '0.02 nm'"
                                  : "max_force = '1e-6 kJ/mol/nm'\nmax_displacement = '0.002 nm'\nsteps = 50000");
    // To each other: the second as near as in the liquid.
    const Vec3<double> apart = scene.particles.unwrapped(3) - scene.particles.unwrapped(0);
    for (Index i = 3; i < 6; ++i)
      scene.particles.shift(i, Vec3<double>(apart * (0.32 / apart.norm() - 1)), Vec3<double>::Zero());
    scene.particles.moved();
    const Minimized done = minimize_start(scene);
    CAPTURE(k, done.steps, done.force);
    CHECK(done.converged());
    energies[k] = energy_of(scene, scene.particles);
    oxygens[k] = distance(scene.particles, 0, 3);
  }
  CHECK(std::abs(energies[0] - energies[1]) < 1e-9);
  CHECK(std::abs(oxygens[0] - oxygens[1]) < 1e-7);
  CHECK(oxygens[0] > 0.26);  // as in the liquid
  CHECK(oxygens[0] < 0.29);
  CHECK(energies[0] < -20);
}

/// Holds all particles where they are, and lets a force on them stand that leads nowhere.
class Nailed final : public MinimizeAlong {
 public:
  void bind(ParticleSystem<double>&) override {}
  void advance_positions(ParticleSystem<double>&, double) override {}
  void project_velocities(ParticleSystem<double>& s, double) override { s.velocities().set_zero(); }
  void constrain(const ParticleSystem<double>&, VectorColumn<double>&) override {}
  std::optional<Failure> take_failure() override { return {}; }
};

TEST_CASE("a minimization that no step takes further ends by name, with its particles where they were",
          "[scene][minimize]") {
  Scene scene = water(27, "max_force = '1 kJ/mol/nm'");
  const ParticleSystem<double> before = scene.particles;
  ForceField<double> forces;
  for (const SceneForce& force : scene.hamiltonian.terms()) forces.add(force.force);
  Nailed nailed;
  const Minimized done = minimize(scene.particles, AnyForce<double>(forces), {.max_force = 1, .steps = 20000}, &nailed);
  REQUIRE(done.failure);
  CHECK_THAT(done.failure->message, Catch::Contains("no step downhill changes it any more"));
  CHECK(done.steps < 20000);
  for (Index i = 0; i < before.size(); ++i) CHECK(scene.particles.positions()[i] == before.positions()[i]);
}

}  // namespace noether::test

// The scene of a liquid of rigid molecules in a periodic box: what is kept, and what no bit may depend on.

#include "tests/support/molecules.hpp"
#include "io/digest.hpp"
#include "monitors/monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "monitors/temperature.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/settings.hpp"

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace noether::test {
namespace {

Scene molecules(const std::vector<std::string>& sets = {}) {
  const auto scenes = std::filesystem::path(NOETHER_SOURCE_DIR) / "tests" / "scenes" / "good";
  return load_scene(scenes / "rigid_molecules.toml", standard_parts(), sets);
}

/// The settled particles of a scene's run.
ParticleSystem<double> end_of(const Scene& scene) {
  Simulation<double> sim = assemble(scene);
  REQUIRE(sim.run(*scene.integrator.steps).ok());
  return sim.particles();
}

const std::vector<std::string> briefly = {"integrator.steps=60"};

TEST_CASE("a scene ties all bonds and angles of its structure, cut by the box as they are", "[scene][molecules]") {
  const Scene scene = molecules();
  const ConstraintSet set = constraints_of(scene);
  CHECK(scene.particles.size() == 81);
  CHECK(set.equations() == 81);
  CHECK(set.worst(scene.particles).residual < 1e-11);
  // Some of the molecules lie across a face: their atoms are far apart in the cell.
  double farthest = 0;
  for (const BondedTerm<2>& bond : scene.particles.topology()->bonds) {
    const Vec3<double> d =
        scene.particles.positions()[bond.particles[0]] - scene.particles.positions()[bond.particles[1]];
    farthest = std::max(farthest, std::sqrt(norm2(d)));
  }
  CHECK(farthest > 5);
}

TEST_CASE("a scene of rigid molecules keeps energy to the square of the step, and momentum", "[scene][molecules]") {
  const auto rms = [](const std::string& step, std::int64_t steps, const std::string& method) {
    const Scene scene = molecules({"integrator.step=" + step, "integrator.method=" + method});
    Simulation<double> sim(scene.particles, integrator_of(scene), std::stod(step));
    auto& energy = sim.every(steps / 100, Energy{});
    const auto& temperature = sim.every(steps / 100, Temperature{});
    REQUIRE(sim.run(steps).ok());
    CHECK(temperature.degrees_of_freedom() == 3 * 81 - 81 - 3);
    Vec3<double> momentum = Vec3<double>::Zero();
    const ParticleSystem<double>& s = sim.particles();
    for (Index i = 0; i < s.size(); ++i) {
      momentum += s.masses()[i] * (s.velocities()[i] - scene.particles.velocities()[i]);
    }
    CHECK(std::sqrt(norm2(momentum)) < 1e-12);
    CHECK(constraints_of(scene).worst(s).residual < 1e-14);
    return *energy.report().rms;
  };
  const double coarse = rms("0.002", 500, "verlet"), fine = rms("0.001", 1000, "verlet");
  CHECK(std::abs(coarse / fine - 4) < 0.2);
  const double fourth = rms("0.002", 500, "yoshida_4"), finer = rms("0.001", 1000, "yoshida_4");
  CHECK(std::abs(fourth / finer - 16) < 2);
}

TEST_CASE("the shadow of a scene of rigid molecules is kept to rounding", "[scene][molecules]") {
  const Scene scene = molecules();
  Simulation<double> sim(scene.particles, integrator_of(scene), scene.integrator.step);
  const auto& shadow = sim.every(1, ShadowHamiltonian<double>{});
  REQUIRE(sim.run(500).ok());
  CHECK(*shadow.report().worst < 1e-11);
}

TEST_CASE("where the box of a scene is cut does not change its molecules: forces at once, bits after some steps",
          "[scene][molecules]") {
  const Scene scene = molecules(briefly);
  const auto accelerations = [](const Scene& of) {
    ParticleSystem<double> s = of.particles;
    s.clock() = Clock<double>::fixed(0, of.integrator.step);
    AnyHamiltonian<double> hamiltonian = hamiltonian_of(of);
    hamiltonian.bind(s);
    VectorColumn<double> a(s.size());
    hamiltonian.accelerations(s, a);
    return a;
  };
  const auto straight = end_of(scene);
  const auto a = accelerations(scene);
  // Shifts on the grid of the box of edge 6 change nothing; others round positions once.
  for (const auto& [aside, allowed] :
       {std::pair{Vec3<double>(3, 0, 0), 0.0}, std::pair{Vec3<double>(0.75, 5.25, 3.5), 0.0},
        std::pair{Vec3<double>(0.3, 1.9, 4.7), 1e-11}}) {
    Scene other = scene;
    for (Index i = 0; i < other.particles.size(); ++i) other.particles.shift(i, aside, Vec3<double>::Zero());
    other.particles.moved();
    CHECK(difference(end_of(other), straight, aside) <= allowed);
    const auto b = accelerations(other);
    CHECK((a.all() - b.all()).cwiseAbs().maxCoeff() <= allowed);
  }
  CHECK(difference(straight, scene.particles, Vec3<double>::Zero()) > 0.05);
}

TEST_CASE("bits of a scene of molecules depend on no thread, skin or save; a bath and other solvers run too",
          "[scene][molecules]") {
  const std::vector<std::vector<std::string>> ways = {
      {},
      {"hamiltonian.constraint.0.solver=rattle", "hamiltonian.constraint.0.tolerance=1e-9"},
      {"hamiltonian.constraint.0.solver=p_shake", "hamiltonian.constraint.0.tolerance=1e-9"},
      {"hamiltonian.constraint.0.solver=m_shake"},
      {"integrator.method=yoshida_4"},
      {"integrator.method=BAOAB", "hamiltonian.thermostat={type='langevin', temperature=0.7, friction=1, seed=4}"}};
  for (std::vector<std::string> way : ways) {
    way.insert(way.end(), briefly.begin(), briefly.end());
    way.emplace_back("every=[]");
    CAPTURE(way.front());
    const Scene scene = molecules(way);
    const auto straight = end_of(scene);
    for (const int threads : {1, 2, 3}) {
      const Threads so_many(threads);
      CHECK(io::digest(end_of(scene)) == io::digest(straight));
    }
    for (const std::string skin : {"0.1", "0.9"}) {
      auto skinned = way;
      skinned.push_back("hamiltonian.neighbors={skin=" + skin + "}");
      CHECK(io::digest(end_of(molecules(skinned))) == io::digest(straight));
    }
    Simulation<double> first = assemble(scene), second = assemble(scene);
    REQUIRE(first.run(23).ok());
    second.restore(first.save());
    REQUIRE(second.run(37).ok());
    CHECK(io::digest(second.particles()) == io::digest(straight));
  }
}

}  // namespace
}  // namespace noether::test

// What `stability` and `explain` say of bodies that turn.

#include "study/turning_steps.hpp"
#include "study/spectrum.hpp"
#include "study/stability.hpp"
#include "tests/study/scenes.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <string>

namespace noether::test {
namespace {

/// A slow rock and a fast one on a spring each.
Scene rocks(const std::string& rotor) {
  return read_scene(
      "units = 'reduced'\n"
      "[[particles.rigid_body]]\nname = 'slow'\nmass = 1\ninertia = [1, 2, 2.5]\nx = [1, 0, 0]\n"
      "v = [0, 0, 0]\nangular_velocity = [0, 0, 1]\n"
      "[[particles.rigid_body]]\nname = 'fast'\nmass = 1\ninertia = [1, 2, 2.5]\nx = [0, 1, 0]\n"
      "v = [0, 0, 0]\nangular_velocity = [0, 6, 8]\n"
      "[hamiltonian]\ntype = 'kinetic_potential'\nrotor = '" +
          rotor +
          "'\n[[hamiltonian.force]]\ntype = 'harmonic_field'\nk = 1\n"
          "[integrator]\nmethod = 'verlet'\nstep = 0.01\nsteps = 1000\n",
      "rocks.toml");
}

}  // namespace

TEST_CASE("the fastest turn is known, and a rule of steps where turns are not exact", "[stability][bodies]") {
  for (const std::string rotor : {"exact", "axes"}) {
    const Stability found =
        find_stability(rocks(rotor), {.methods = {"verlet"}, .confirm_steps = 1000, .row_budget = 0.5});
    REQUIRE(found.turning);
    CHECK(std::abs(found.turning->period - 2 * std::acos(-1.0) / 10) < 1e-14);
    CHECK(found.turning->body == "fast");
    const bool by_axes = rotor == "axes";
    CHECK(found.turning->by_axes == by_axes);
    REQUIRE(found.rows.at(0).recommended_step);
    if (by_axes) CHECK(std::abs(*found.rows[0].recommended_step - std::acos(-1.0) / 100) < 1e-12);
    if (!by_axes) CHECK(*found.rows[0].recommended_step > 0.2);  // that of the spring
    CHECK(to_text(found).find(by_axes ? "fast turns fastest, once in 0.628319: 20 steps in it, at most 0.03142, are a "
                                        "rule for turns axis by axis"
                                      : "fast turns fastest, once in 0.628319: exact turns follow it at any step") !=
          std::string::npos);
    CHECK(to_json(found).find("\"period_of\":\"fast\"") != std::string::npos);
  }
}

TEST_CASE("a body that falls leaves by itself, and no step is blamed for it", "[stability][bodies]") {
  for (const std::string rotor : {"exact", "axes"}) {
    const Scene falling = read_scene(
        "units = 'reduced'\n[[particles.rigid_body]]\nname = 'rock'\nmass = 1\ninertia = [1, 2, 2.5]\nx = [0, 0, 0]\n"
        "v = [1, 0, 0]\nangular_velocity = [0, 0.1, 0.2]\n[hamiltonian]\ntype = 'kinetic_potential'\nrotor = '" +
            rotor +
            "'\n[[hamiltonian.force]]\ntype = 'uniform_field'\nacceleration = [0, 0, -1]\n"
            "[integrator]\nmethod = 'verlet'\nstep = 0.1\nsteps = 1000\n",
        "falling.toml");
    const Stability found = find_stability(falling, {.methods = {"verlet"}, .confirm_steps = 1000, .row_budget = 2});
    CHECK(found.solution_leaves);
    INFO(to_text(found));
    CHECK((!found.rows.at(0).limit_step || *found.rows[0].limit_step > 0.5));
  }
}

TEST_CASE("frequencies of a scene of bodies are those on its way, as of points", "[stability][bodies]") {
  // From the far end of an orbit of e = 0.5 once round: near the star they are 3^(3/2) times those of the start.
  const Scene orbit = read_scene(
      "units = 'reduced'\n[[particles.rigid_body]]\nname = 'star'\nmass = 1\ninertia = [1e-5, 1e-5, 1e-5]\n"
      "x = [0, 0, 0]\nv = [0, 0, 0]\n[[particles.rigid_body]]\nname = 'rock'\nmass = 1e-6\n"
      "inertia = [1e-13, 2e-13, 2.5e-13]\na = 1\ne = 0.5\nM = 3.14159265358979\nangular_velocity = [0, 0, 1]\n"
      "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'gravity_of_bodies'\n"
      "[integrator]\nmethod = 'srkn14a'\nstep = 0.05\nsteps = 126\n",
      "orbit.toml");
  const double start = spectrum_at(orbit, orbit.particles).fastest, way = spectrum_along(orbit).fastest;
  CHECK(std::abs(start - std::pow(1.5, -1.5)) < 1e-3);
  CHECK(way / start > 4.9);
  CHECK(way / start < 5.2);
}

TEST_CASE("points do not turn, nor bodies without spin", "[stability][bodies]") {
  Scene still = rocks("exact");
  for (Index i = 0; i < 2; ++i) still.particles.column<BodySpin>().set(i, Vec3<double>::Zero());
  CHECK_FALSE(turning_steps(still));
}

}  // namespace noether::test

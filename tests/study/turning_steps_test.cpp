// What `stability` and `explain` say of bodies that turn.

#include "study/turning_steps.hpp"
#include "study/candidate.hpp"
#include "study/spectrum.hpp"
#include "study/stability.hpp"
#include "tests/study/scenes.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace noether::test {
namespace {

/// A slow rock and a fast one on a spring each.
/// @param rotor  of the Hamiltonian; none where it is empty
Scene rocks(const std::string& rotor, const std::string& method = "verlet") {
  return read_scene(
      "units = 'reduced'\n"
      "[[particles.rigid_body]]\nname = 'slow'\nmass = 1\ninertia = [1, 2, 2.5]\nx = [1, 0, 0]\n"
      "v = [0, 0, 0]\nangular_velocity = [0, 0, 1]\n"
      "[[particles.rigid_body]]\nname = 'fast'\nmass = 1\ninertia = [1, 2, 2.5]\nx = [0, 1, 0]\n"
      "v = [0, 0, 0]\nangular_velocity = [0, 6, 8]\n"
      "[hamiltonian]\ntype = 'kinetic_potential'\n" +
          (rotor.empty() ? "" : "rotor = '" + rotor + "'\n") +
          "[[hamiltonian.force]]\ntype = 'harmonic_field'\nk = 1\n[integrator]\nmethod = '" + method +
          "'\nstep = 0.01\nsteps = 1000\n",
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
    CHECK(found.turning->rotor == (by_axes ? Rotor::axes : Rotor::exact));
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

TEST_CASE("the rule of steps is that of the rotor in use, and that of each method of a row", "[stability][bodies]") {
  const double rule = std::acos(-1.0) / 100;
  const auto steps = [](const std::string& rotor, const std::string& method) {
    return turning_steps(rocks(rotor, method)).value();
  };
  for (const TurningSteps& discrete : {steps("variational", "verlet"), steps("", "lie_group_variational")}) {
    CHECK(discrete.rotor == Rotor::variational);
    CHECK(std::abs(*discrete.recommended() - rule) < 1e-12);
    CHECK(std::abs(*discrete.limit() - 0.1) < 1e-14);  // h omega = 1
  }
  const TurningSteps on_group = steps("", "rkmk_rk4");
  CHECK_FALSE(on_group.rotor);
  CHECK(std::abs(*on_group.recommended() - rule) < 1e-12);
  CHECK_FALSE(on_group.limit());
  const Stability found = find_stability(
      rocks("", "lie_group_variational"),
      {.methods = {"lie_group_variational", "verlet", "rkmk_rk4"}, .confirm_steps = 1000, .row_budget = 0.3});
  CHECK(to_text(found).find("20 steps in it, at most 0.03142, are a rule for the variational rotor, which has no turn "
                            "beyond steps of about 0.1") != std::string::npos);
  CHECK(to_json(found).find("\"rotor\":\"variational\"") != std::string::npos);
  CHECK(std::abs(*found.rows.at(0).recommended_step - rule) < 1e-12);
  CHECK(*found.rows.at(1).recommended_step > 0.2);  // exact turns
  CHECK(std::abs(*found.rows.at(2).recommended_step - rule) < 1e-12);
}

TEST_CASE("frequencies of bodies are those of forces on their sites, and points that are fixed have none",
          "[stability][bodies]") {
  const std::string dumbbell =
      "units = 'reduced'\n[[particles.rigid_body]]\nname = 'dumbbell'\nlinear = true\nx = [1, 0, 0]\nv = [0, 0, 0]\n"
      "angular_velocity = [0, 0, 1]\n"
      "[[particles.rigid_body.site]]\nplace = [0.1, 0, 0]\nmass = 0.5\n"
      "[[particles.rigid_body.site]]\nplace = [-0.1, 0, 0]\nmass = 0.5\n";
  const std::string top =
      "[[particles.rigid_body]]\nname = 'top'\nmass = 0.01\ninertia = [1, 1, 0.5]\nfixed_point = [0, 0, 0]\n"
      "center = [0, 0, 1]\nangular_velocity = [0, 0, 1]\n";
  const std::string on_springs =
      "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'harmonic_field'\nk = 1\n";
  for (const std::string method : {"verlet", "rkmk_rk4"}) {
    CAPTURE(method);
    const std::string by = "[integrator]\nmethod = '" + method + "'\nstep = 0.01\nsteps = 100\n";
    for (const std::string& bodies : {dumbbell, dumbbell + top}) {
      const Scene scene = read_scene(bodies + on_springs + by, "dumbbell.toml");
      CHECK(std::abs(spectrum_at(scene, scene.particles).fastest - std::sqrt(2.0)) < 1e-12);
      CHECK(is_linear(scene));
    }
  }
  const Scene waters = load_scene(NOETHER_SOURCE_DIR "/examples/rigid_water/scene.toml");  // charges are at sites alone
  CHECK(spectrum_at(waters, waters.particles).fastest > 0);
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
  for (const std::string by : {"method = 'srkn14a'\nstep = 0.05\nsteps = 126\n",
                               "method = 'rkmk_dormand_prince_5'\nrtol = 1e-8\nuntil = 6.3\n"}) {
    const Scene orbit = read_scene(
        "units = 'reduced'\n[[particles.rigid_body]]\nname = 'star'\nmass = 1\ninertia = [1e-5, 1e-5, 1e-5]\n"
        "x = [0, 0, 0]\nv = [0, 0, 0]\n[[particles.rigid_body]]\nname = 'rock'\nmass = 1e-6\n"
        "inertia = [1e-13, 2e-13, 2.5e-13]\na = 1\ne = 0.5\nM = 3.14159265358979\nangular_velocity = [0, 0, 1]\n"
        "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'gravity_of_bodies'\n"
        "[integrator]\n" +
            by,
        "orbit.toml");
    CAPTURE(by);
    const double start = spectrum_at(orbit, orbit.particles).fastest, way = spectrum_along(orbit).fastest;
    CHECK(std::abs(start - std::pow(1.5, -1.5)) < 1e-3);
    CHECK(way / start > 4.9);
    CHECK(way / start < 5.2);
  }
}

TEST_CASE("points do not turn, nor bodies without spin", "[stability][bodies]") {
  Scene still = rocks("exact");
  for (Index i = 0; i < 2; ++i) still.particles.column<BodySpin>().set(i, Vec3<double>::Zero());
  CHECK_FALSE(turning_steps(still));
}

TEST_CASE("bodies, actions and frames are compared with methods of their own families", "[compare]") {
  const auto has = [](const Scene& scene, const std::string& name) {
    const std::vector<Candidate> all = default_opponents(scene);
    return std::any_of(all.begin(), all.end(), [&](const Candidate& who) { return who.label == name; });
  };
  const auto system = [](const std::string& type) {
    return read_scene(
        "units = 'reduced'\n[system]\ntype = '" + type + "'\n[integrator]\nmethod = 'rk4'\nstep = 0.1\nsteps = 10\n",
        "system.toml");
  };
  CHECK(has(rocks("exact"), "rkmk_dop853"));
  CHECK_FALSE(has(kepler(0.1, "method = 'verlet'\nstep = 0.01\nsteps = 10"), "rkmk_dop853"));
  CHECK(has(system("polar_kepler"), "galerkin_gauss_4"));
  CHECK_FALSE(has(system("polar_kepler"), "magnus_6"));
  CHECK(has(system("turning_frame"), "magnus_6"));
  CHECK_FALSE(has(system("lorenz"), "galerkin_gauss_4"));
}

}  // namespace noether::test

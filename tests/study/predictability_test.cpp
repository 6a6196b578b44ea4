// How fast small differences grow: the rate of a chaotic motion against exponents that are known.

#include "study/predictability.hpp"
#include "study/horizon.hpp"
#include "tests/study/scenes.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace noether::test {
namespace {

Scene lorenz_from(double x, double y, double z) {
  return read_scene(fmt::format(R"(units = "reduced"
[system]
type = "lorenz"
start = [{}, {}, {}]
[integrator]
method = "dop853"
rtol = 1e-9
until = 60
)",
                                x, y, z),
                    "lorenz.toml");
}

TEST_CASE("the rate of Lorenz's system is its Lyapunov exponent, 0.906, however long it is asked for",
          "[predictability]") {
  double sum = 0;
  int count = 0;
  for (int k = 0; k < 6; ++k) {
    const Scene scene = lorenz_from(1 + 0.7 * k, 1 - 0.3 * k, 20 + k);
    for (const double end : {60.0, 30.0, 20.0}) {
      const auto motion = predictability(scene, end, 600);
      REQUIRE(motion);
      CAPTURE(k, end, motion->rate, motion->e_foldings);
      REQUIRE(motion->chaotic);
      // From ten times the start to half of the end: of a growth of 1e7 or more.
      CHECK(motion->e_foldings > 12);
      CHECK(std::abs(motion->e_foldings - std::log(motion->growth.back() / 20)) < 1.5);
      // The exponent of a stretch of 15 e-foldings scatters by about 0.1; that of the last half alone by 0.25.
      CHECK(std::abs(motion->rate - 0.906) < 0.2);
      sum += motion->rate;
      ++count;
    }
  }
  CHECK(std::abs(sum / count - 0.906) < 0.06);
}

TEST_CASE("an unstable step is not taken for chaos", "[predictability]") {
  const auto spring = [](double step) {
    return read_scene(fmt::format(R"(units = "reduced"
[[particles.body]]
mass = 1
x = [1, 0, 0]
v = [0, 1, 0]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "harmonic_field"
k = 100
[integrator]
method = "verlet"
step = {}
until = 60
)",
                                  step),
                      "spring.toml");
  };
  for (const double step : {0.19, 0.205, 0.6, 3.0}) {  // stable below 0.2
    const auto motion = predictability(spring(step), 60, 60);
    REQUIRE(motion);
    CAPTURE(step);
    CHECK_FALSE(motion->chaotic);
    CHECK(motion->unstable_step == (step < 0.2 ? 0 : step));
    CHECK(motion->factor(60) < 100);
  }
}

TEST_CASE("where the work does not last for shorter steps, a chaotic motion is told by those of the scene",
          "[predictability]") {
  // Two pulls beside each other: a third body that falls between them, by steps that growth is fast for.
  const Scene scene = read_scene(R"(units = "reduced"
[[particles.body]]
mass = 1
x = [1, 0, 0]
v = [0, 0.5, 0]
[[particles.body]]
mass = 1
x = [-1, 0, 0]
v = [0, -0.5, 0]
[[particles.body]]
mass = 0.5
x = [0.1, 1.3, 0]
v = [0.2, 0, 0]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "gravity"
softening = 0.1
[integrator]
method = "verlet"
step = 0.06
until = 200
)",
                                 "three.toml");
  double spent = 0;
  const auto whole = predictability(scene, 200, 60, 1e9, {}, &spent);
  REQUIRE(whole);
  REQUIRE(whole->chaotic);
  CHECK(whole->unstable_step == 0);
  CHECK(whole->evaluations == spent);
  for (const double most : {0.2, 0.35, 0.5, 0.8}) {
    CAPTURE(most);
    const auto part = predictability(scene, 200, 60, most * spent, {}, nullptr);
    REQUIRE(part);
    CHECK(part->unstable_step == 0);
    CHECK(part->evaluations <= most * spent * 1.1);
  }
}

TEST_CASE("a rate is told with the e-foldings that it is fitted over, if it is", "[predictability]") {
  const Scene scene = lorenz_from(1, 1, 20);
  Predictability motion{.chaotic = true, .rate = std::log(10.0) / 2, .e_foldings = 13.4};
  CHECK(tenfold_in_words(motion, scene) == "2 (fitted over 13 e-foldings)");
  motion.e_foldings = 0;
  CHECK(tenfold_in_words(motion, scene) == "2");
}

}  // namespace
}  // namespace noether::test

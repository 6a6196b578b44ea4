#include "engine/monitors.hpp"
#include "engine/orbital_monitors.hpp"
#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/schemes.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "tests/examples/example_run.hpp"

#include <fmt/format.h>

#define main pythagorean_main
#define run_until(end) run(20000)
#include "examples/pythagorean/main.cpp"
#undef run_until
#undef main

TEST_CASE("the Pythagorean program and its scene end in the same digest", "[examples]") {
  noether::check_same_digest("pythagorean", pythagorean_main, 20000);
}

TEST_CASE("the Pythagorean scene does what it expects", "[examples][.][nightly]") {
  noether::check_expectations("pythagorean");
}

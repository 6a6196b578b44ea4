#include "engine/monitors.hpp"
#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/schemes.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "tests/examples/example_run.hpp"

#include <fmt/format.h>
#include <cmath>

#define main kepler_main
#define run(end) run(400)
#include "examples/kepler/main.cpp"
#undef run
#undef main

TEST_CASE("the Kepler program and its scene end in the same digest", "[examples]") {
  noether::check_same_digest("kepler", kepler_main, 400);
}

TEST_CASE("the Kepler scene does what it expects", "[examples]") { noether::check_expectations("kepler"); }

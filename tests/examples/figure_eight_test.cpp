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
#include <cmath>

#define main figure_eight_main
#define run(end) run(400)
#include "examples/figure_eight/main.cpp"
#undef run
#undef main

TEST_CASE("the figure-eight program and its scene end in the same digest", "[examples]") {
  noether::check_same_digest("figure_eight", figure_eight_main, 400);
}

TEST_CASE("the figure-eight scene does what it expects", "[examples]") { noether::check_expectations("figure_eight"); }

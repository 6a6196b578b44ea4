#include "engine/monitors.hpp"
#include "engine/orbital_monitors.hpp"
#include "engine/simulation.hpp"
#include "engine/units.hpp"
#include "integrators/composition.hpp"
#include "integrators/schemes.hpp"
#include "integrators/wisdom_holman.hpp"
#include "io/bodies.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "tests/examples/example_run.hpp"

#include <fmt/format.h>

#define main solar_system_main
#define run_until(end) run(730)
#include "examples/solar_system/main.cpp"
#undef run_until
#undef main

TEST_CASE("the solar system program and its scene end in the same digest", "[examples]") {
  noether::check_same_digest("solar_system", solar_system_main, 730);
}

TEST_CASE("the solar system scene does what it expects", "[examples][slow]") {
  noether::check_expectations("solar_system");
}

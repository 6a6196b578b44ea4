#include "engine/monitors.hpp"
#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/linear_drag.hpp"
#include "forces/sum.hpp"
#include "integrators/composition.hpp"
#include "integrators/damped.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/schemes.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "tests/examples/example_run.hpp"

#include <fmt/format.h>
#include <cmath>

#define main driven_oscillator_main
#define run_until(end) run(1000)
#include "examples/driven_oscillator/main.cpp"
#undef run_until
#undef main

TEST_CASE("the driven oscillator program and its scene end in the same digest", "[examples]") {
  noether::check_same_digest("driven_oscillator", driven_oscillator_main, 1000);
}

TEST_CASE("the driven oscillator scene does what it expects", "[examples]") {
  noether::check_expectations("driven_oscillator");
}

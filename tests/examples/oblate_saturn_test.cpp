#include "examples/oblate_saturn/oblateness.hpp"

#include "engine/monitors.hpp"
#include "engine/orbital_monitors.hpp"
#include "engine/simulation.hpp"
#include "engine/units.hpp"
#include "forces/check_gradient.hpp"
#include "forces/gravity.hpp"
#include "forces/sum.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/schemes.hpp"
#include "io/bodies.hpp"
#include "io/digest.hpp"
#include "tests/examples/example_run.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>

#define main oblate_saturn_main
#define run_until(end) run(1000)
#include "examples/oblate_saturn/main.cpp"
#undef run_until
#undef main

#define main oblate_saturn_from_scene
#include "examples/oblate_saturn/from_scene.cpp"
#undef main

namespace {

noether::Parts parts() {
  noether::Parts all = noether::standard_parts();
  all.add_force<Oblateness>();
  return all;
}

}  // namespace

TEST_CASE("the oblate Saturn program and its scene end in the same digest", "[examples]") {
  noether::check_same_digest("oblate_saturn", oblate_saturn_main, 1000, parts());
}

TEST_CASE("the oblate Saturn scene does what it expects", "[examples][slow]") {
  noether::check_expectations("oblate_saturn", parts());
}

TEST_CASE("three lines of program run the user's force from the scene file", "[examples][slow]") {
  const noether::ExampleFolder folder("oblate_saturn");
  const std::string output = noether::output_of(oblate_saturn_from_scene);
  INFO(output);
  CHECK(noether::digest_in(output) == noether::digest_of_scene(525'960, parts()));
  CHECK(std::filesystem::exists("scene.out/run.h5"));
}

/// The particles of a scene are copied once, for the run.

#include "numbers/types.hpp"
#include "scene/scene.hpp"
#include "tests/allocation/watched.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

namespace noether {
namespace {

/// No power of two, so that what grows never has the size of a copy.
constexpr int bodies = 1003;

std::string many_bodies() {
  std::string text = "units = \"reduced\"\n";
  for (int k = 0; k < bodies; ++k) {
    text += fmt::format("[[particles.body]]\nname = \"b{}\"\nmass = 1\nx = [{}, 0, 0]\nv = [0, 1, 0]\n", k, k);
  }
  return text +
         "[hamiltonian]\ntype = \"kinetic_potential\"\n[[hamiltonian.force]]\ntype = \"harmonic_field\"\nk = 1\n"
         "[integrator]\nmethod = \"verlet\"\nstep = 0.01\nsteps = 10\n[[every]]\ntype = \"energy\"\nsteps = 5\n";
}

/// How many lists of as many names as there are bodies `make` allocates: each copy of the particles has one.
template <class Make> long copies_in(const Make& make) {
  test::watched_bytes = bodies * sizeof(std::string);
  test::watched_allocations = 0;
  make();
  test::watched_bytes = 0;
  return test::watched_allocations;
}

}  // namespace

TEST_CASE("reading, checking and assembling a scene copies its particles once", "[allocation]") {
  const std::string text = many_bodies();
  std::optional<SceneRun> start;
  CHECK(copies_in([&] { start.emplace(read_run(text, "bodies.toml")); }) == 1);
  std::optional<Simulation<double>> sim;
  CHECK(copies_in([&] { sim.emplace(start->assemble()); }) == 0);
  CHECK(sim->particles().size() == bodies);
  // The count sees copies: that of a scene, and that of the run which is made of it.
  std::optional<Scene> other;
  CHECK(copies_in([&] { other.emplace(start->scene()); }) == 1);
  CHECK(copies_in([&] { sim.emplace(assemble(*other)); }) == 1);
}

}  // namespace noether

// A pair potential of one's own, as CONTRIBUTING.md shows it: in a program and in a scene, beside the built-in force.

#include "engine/simulation.hpp"
#include "forces/pair_force.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "scene/parts.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/liquid.hpp"
#include "tests/support/pair_forces.hpp"
#include "tests/support/process.hpp"

#include <filesystem>
#include <string>
#include <utility>

namespace noether {
namespace {

/// U = 4 epsilon ((sigma/r)^12 - (sigma/r)^6)
struct TwelveSix {
  double epsilon = 0;  // [energy]
  double sigma = 0;    // [length]

  static constexpr auto describe() {  // for scenes; programs do without
    return part<TwelveSix>("twelve_six", "Lennard-Jones as a user writes it",
                           formula("U = 4 epsilon ((sigma/r)^12 - (sigma/r)^6), r < cutoff"),
                           field<&TwelveSix::epsilon>("epsilon", "energy", "depth of the well").required("1"),
                           field<&TwelveSix::sigma>("sigma", "length", "where U is 0").required("1"));
  }
  double scale() const { return 24 * epsilon / sigma; }  // a strong force of everyday: sums count whole units of it
  template <class Real> PairTerms<Real> operator()(const Real& r2) const {
    const Real s2 = Real(sigma * sigma) / r2, s6 = s2 * s2 * s2;
    return {Real(4 * epsilon) * s6 * (s6 - Real(1)), Real(24 * epsilon) * s6 * (Real(2) * s6 - Real(1)) / r2};
  }
};

Outcome program(ParticleSystem<double> atoms) {
  const PairForce<TwelveSix> force{{.epsilon = 1, .sigma = 1}, 2.5, Cutoff::switch_c4};
  Simulation sim(std::move(atoms), compose(KineticPotential(force), schemes::verlet), 0.005);
  return sim.run(100);
}

Scene own_scene(const std::filesystem::path& file) {  // exit_code(run(own_scene("scene.toml"))) runs it
  Parts parts = standard_parts();
  parts.add_force<PairForce<TwelveSix>>();
  return load_scene(file, parts);
}

/// What stands between the lines ```KIND and ``` of a page, from its first such block after `from` on.
std::string next_block(const std::string& page, const std::string& kind, std::size_t& from) {
  const std::string begin = "```" + kind + "\n";
  const std::size_t first = page.find(begin, from);
  REQUIRE(first != std::string::npos);
  from = page.find("```\n", first + begin.size());
  REQUIRE(from != std::string::npos);
  return page.substr(first + begin.size(), from - first - begin.size());
}

const std::filesystem::path source_folder = NOETHER_SOURCE_DIR;

}  // namespace

TEST_CASE("the pair potential of CONTRIBUTING.md is compiled as it stands there, and is Lennard-Jones", "[scene]") {
  const std::string page = test::read_text(source_folder / "CONTRIBUTING.md");
  const std::string here = test::read_text(source_folder / "tests" / "scene" / "own_pair_test.cpp");
  std::size_t at = page.find("**A pair potential**");
  REQUIRE(at != std::string::npos);
  for (int k = 0; k < 2; ++k) CHECK(here.find(next_block(page, "cpp", at)) != std::string::npos);

  CHECK(program(test::liquid(4, 0.85, 1, 0.05)).ok());

  const test::ScratchFolder folder;
  const std::string lattice =
      "units = \"reduced\"\n[particles]\ntype = \"lattice\"\ncells = [4, 4, 4]\ndensity = 0.8442\nmass = 1\n"
      "temperature = 1.44\n[hamiltonian]\ntype = \"kinetic_potential\"\n[integrator]\nmethod = \"verlet\"\n"
      "step = 0.005\nsteps = 100\n";
  const std::string force = next_block(page, "toml", at);
  test::write_text(folder / "own.toml", lattice + force);
  std::string built_in = force;
  test::write_text(folder / "built_in.toml", lattice + built_in.replace(force.find("twelve_six"), 10, "lennard_jones"));
  Simulation<double> own = assemble(own_scene(folder / "own.toml"));
  Simulation<double> other = assemble(load_scene(folder / "built_in.toml"));
  REQUIRE(own.run(100).ok());
  REQUIRE(other.run(100).ok());
  const double difference = test::largest_difference(own.particles().positions(), other.particles().positions());
  CHECK(difference < 1e-9);  // 100 steps on, of a melt that forgets its start
  CHECK(difference > 0);     // other code, other rounding
}

}  // namespace noether

// A Hamiltonian system from outside the library that names what it keeps: scenes keep that by its name.

#include "integrators/hamiltonian_system.hpp"
#include "integrators/methods/kept_invariants.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace noether {

namespace {

struct TurnInPlane {
  template <class Real> Real operator()(const Vector<Real>& q, const Vector<Real>& p) const {
    return q[0] * p[1] - q[1] * p[0];
  }
};

/// An orbit of e = 0.6 in a plane, from its pericenter.
struct OrbitOfItsOwn {
  static constexpr auto describe() {
    return part<OrbitOfItsOwn>("orbit_of_its_own", "an orbit that names its angular momentum");
  }
  Index size() const { return 2; }
  std::vector<double> start() const { return {0.4, 0, 0, 2}; }
  std::vector<NamedInvariant> invariants() const { return {invariant("turn", TurnInPlane{})}; }
  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    using std::sqrt;
    return (p[0] * p[0] + p[1] * p[1]) / Real(2) - Real(1) / sqrt(q[0] * q[0] + q[1] * q[1]);
  }
};

Scene scene_with(const std::string& invariants) {
  Parts parts = standard_parts();
  parts.add_system<OrbitOfItsOwn>();
  return read_scene(
      "units = \"reduced\"\n[system]\ntype = \"orbit_of_its_own\"\n[integrator]\nmethod = \"hbvm_2\"\n"
      "step = 0.05\nsteps = 50\n" +
          invariants,
      "scene.toml", parts);
}

double turn_of(Simulation<double>& run) {
  const std::vector<double>& y = run.particles().variables();
  return y[0] * y[3] - y[1] * y[2];
}

}  // namespace

TEST_CASE("a scene keeps what its system names, with the bits of a program", "[scene][line_invariants]") {
  const Scene list = scene_with("invariants = [\"energy\", \"turn\"]\n");
  CHECK(list.effective_toml.find("invariants = [\"energy\", \"turn\"]\n") != std::string::npos);
  const LineInvariants both{.invariants = {"energy", "turn"}};
  Simulation<double> by_list = assemble(list),
                     by_text = assemble(scene_with("invariants = \"energy, turn\"\n")),  // as older scenes have it
      program(initial_state(OrbitOfItsOwn{}), classical(OrbitOfItsOwn{}, method("hbvm_2", both)), 0.05),
                     alone = assemble(scene_with(""));
  for (auto* run : {&by_list, &by_text, &program, &alone}) REQUIRE(run->run(50).ok());
  CHECK(std::abs(turn_of(by_list) - 0.8) < 1e-14);
  CHECK(std::abs(turn_of(alone) - 0.8) > 1e-9);
  CHECK(by_list.particles().variables() == program.particles().variables());
  CHECK(by_text.particles().variables() == program.particles().variables());
  CHECK_NOTHROW(assemble(list).restore(by_text.save()));
}

TEST_CASE("a list of invariants that means nothing is refused at its line", "[scene][line_invariants]") {
  const auto refused = [](const std::string& invariants) -> std::string {
    try {
      Simulation<double> run = assemble(scene_with(invariants));
    } catch (const Error& error) {
      return error.message();
    }
    return "";
  };
  CHECK(refused("invariants = []\n") == "invariants = [] is empty; give one text or more");
  CHECK(refused("invariants = 3\n") == "invariants = 3 is a whole number; a list is expected");
  CHECK(refused("invariants = [3]\n") == "invariants = 3 is a whole number; a list of texts is expected");
  CHECK(refused("invariants = [\"turn\", \"turn\"]\n") ==
        "invariants = [\"turn\", \"turn\"] has turn twice; give it once");
  CHECK(refused("invariants = [\"energy\", \"trun\"]\n") ==
        "method 'hbvm_2' cannot keep 'trun' of 'orbit_of_its_own', which has none of that name; did you mean 'turn'?");
}

}  // namespace noether

/// What `evaluate` does not know, it calls unknown: energies and virials of forces that claim to have none.

#include "scene/evaluate.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/gyration.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace noether::test {
namespace {

std::string bodies_under(const std::string& hamiltonian) {
  return "units = \"reduced\"\n[[particles.body]]\nname = \"sun\"\nmass = 1\nx = [0, 0, 0]\nv = [0, 0, 0]\n"
         "[[particles.body]]\nname = \"planet\"\nmass = 0.001\nx = [1, 0, 0]\nv = [0, 1, 0]\n[hamiltonian]\n" +
         hamiltonian + "[integrator]\nmethod = \"dop853\"\nuntil = 1\n";
}
const std::string gravity = "[[hamiltonian.force]]\ntype = \"gravity\"\nG = 1\n";
const std::string relativity = "[[hamiltonian.force]]\ntype = \"post_newtonian\"\nG = 1\nc = 10\n";
const std::string tether = "[[hamiltonian.force]]\ntype = \"tether\"\nk = 2\nbodies = [\"planet\"]\n";

Evaluation evaluated(const std::string& hamiltonian) {
  Parts parts = standard_parts();
  parts.add_hamiltonian<Gyration>();
  return evaluate(read_scene(bodies_under(hamiltonian), "scene.toml", parts));
}
double term(const Evaluation& e, const std::string& name) {
  for (const auto& [known, energy] : e.terms) {
    if (known == name) return energy;
  }
  FAIL("there is no term " << name);
  return 0;
}

}  // namespace

TEST_CASE("the energy is unknown where a force has none, and other terms are still told", "[scene][evaluate]") {
  const Evaluation plain = evaluated("type = \"kinetic_potential\"\n" + gravity);
  CHECK(plain.potential == -0.001);
  const Evaluation e = evaluated("type = \"kinetic_potential\"\n" + gravity + relativity);
  CHECK(std::isnan(e.potential));
  CHECK(std::isnan(term(e, "post_newtonian")));
  CHECK(term(e, "gravity") == -0.001);
  CHECK(e.kinetic == plain.kinetic);
  CHECK(std::isfinite(e.force_max));
  CHECK(e.outcome.ok());
  const Evaluation turning = evaluated("type = \"gyration\"\nomega = 2\n" + gravity + relativity);
  CHECK(std::isnan(turning.potential));
  CHECK(term(turning, "gyration") == 0);
}

TEST_CASE("the virial is unknown where a force or a Hamiltonian has none", "[scene][evaluate]") {
  const std::string plain = "type = \"kinetic_potential\"\n";
  CHECK(evaluated(plain + gravity).virial(0, 0) == -0.001);
  CHECK(std::isnan(evaluated(plain + gravity + tether).virial(0, 0)));
  CHECK(evaluated(plain + gravity + tether).potential == -0.001 + 1);
  CHECK(std::isnan(evaluated("type = \"gyration\"\nomega = 2\n" + gravity).virial(0, 0)));
}

}  // namespace noether::test

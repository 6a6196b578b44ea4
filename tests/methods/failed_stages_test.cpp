/// No step stands on stages where a force could not be computed, whether they are evaluated in lanes or one by one.

#include "engine/any_force.hpp"
#include "engine/simulation.hpp"
#include "integrators/classical.hpp"
#include "numbers/select.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"

#include <string>

using namespace noether;

namespace {

/// A spring of 1 to the origin that cannot be computed where x is near a place; its rates are numbers there too.
struct BrokenSpring {
  double place = 0;

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const Vec3<Real> x = s.positions()[0];
    out.acceleration(0, Vec3<Real>(-x));
    if (out.wants_energy()) out.energy(norm2(x) / Real(2));
    const Real off = x[0] - Real(place);
    if (any(off * off < Real(4e-4))) out.fail({Outcome::Kind::solver_failure, 0, "x", "the spring is broken here"});
  }
};

/// The outcome of three steps of 0.5 along x = cos t, whose ends, and the stages of all but the last, are far from it.
Outcome past(double place, const char* name) {
  ParticleSystem<double> s;
  s.add("bob", 1, {1, 0, 0}, {0, 0, 0});
  Simulation<double> run(s, test::classical_over(BrokenSpring{place}, method(name)), 0.5);
  return run.run(3);
}

}  // namespace

TEST_CASE("a step whose stages stand where a force fails ends the run, in lanes too", "[failed_stages]") {
  // The first stage of gauss_2 in the third step is at cos(1.1057).
  const Outcome gauss = past(0.4486, "gauss_2"), line = past(0.4486, "hbvm_2_2");
  for (const Outcome& outcome : {gauss, line}) {
    CHECK(outcome.kind == Outcome::Kind::solver_failure);
    CHECK(outcome.step == 2);
    CHECK(outcome.message.find("the spring is broken here") != std::string::npos);
  }
  CHECK(past(0.31, "gauss_2").ok());  // where no stage comes
}

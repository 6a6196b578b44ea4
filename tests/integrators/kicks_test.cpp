/// Forces that take part in kicks of different letters: multiple time steps over the plain Hamiltonian.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/settings.hpp"

#include <cmath>
#include <string>

namespace noether {
namespace {

ParticleSystem<double> planet() {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("sun", 1, Vec3<double>::Zero(), Vec3<double>::Zero());
  s.add("planet", 1e-3, Vec3<double>(1, 0, 0), Vec3<double>(0, 1.1, 0));
  return s;
}

/// Gravity in kicks B, a weak spring to the origin in kicks C.
ForceField<double> fast_and_slow() {
  ForceField<double> field;
  field.add(Gravity{.G = 1});
  field.add(AnyForce<double>(HarmonicField{.k = 1e-3}).in_kick('C'));
  return field;
}

/// One slow kick for four steps of verlet within.
Scheme multiple_steps() {
  Scheme scheme = word("CBABABABABC");
  return scheme;
}

}  // namespace

TEST_CASE("a Hamiltonian has a kick for each letter that its forces claim", "[integrators][kicks]") {
  const KineticPotential hamiltonian(fast_and_slow());
  CHECK(hamiltonian.claims().alphabet == "ABC");
  CHECK(hamiltonian.claims().kicks == "BC");
  CHECK(hamiltonian.claims().basic == "CBABC");
  CHECK(KineticPotential(Gravity{}).claims().basic == "BAB");
  CHECK(KineticPotential(Sum{Gravity{}, HarmonicField{}}).claims().alphabet == "AB");
}

TEST_CASE("kicks of two letters are those of their sum", "[integrators][kicks]") {
  ForceField<double> together;
  together.add(Gravity{.G = 1}).add(HarmonicField{.k = 1e-3});
  Simulation parted(planet(), compose(KineticPotential(fast_and_slow()), schemes::yoshida_4), 0.01);
  Simulation whole(planet(), compose(KineticPotential(together), schemes::yoshida_4), 0.01);
  REQUIRE(parted.run(300).ok());
  REQUIRE(whole.run(300).ok());
  const Vec3<double> a = parted.particles().positions()[1], b = whole.particles().positions()[1];
  CHECK(std::sqrt(norm2(Vec3<double>(a - b))) < 1e-12);
  CHECK(whole.evaluations().force < parted.evaluations().force);
}

TEST_CASE("multiple time steps evaluate slow forces seldom, and are of order two", "[integrators][kicks]") {
  const auto energy_error = [](double dt, std::int64_t* evaluations) {
    auto integrator = compose(KineticPotential(fast_and_slow()), multiple_steps());
    ParticleSystem<double> s = planet();
    Simulation sim(s, integrator, dt);
    integrator.bind(s);
    const double start = integrator.energy(s).total();
    double worst = 0;
    for (int k = 0; k < 50; ++k) {
      CHECK(sim.run(static_cast<std::int64_t>(std::lround(0.16 / dt))).ok());
      worst = std::max(worst, std::abs(integrator.energy(sim.particles()).total() - start));
    }
    *evaluations = sim.evaluations().force;
    return worst;
  };
  std::int64_t coarse = 0, fine = 0;
  const double order = std::log2(energy_error(0.08, &coarse) / energy_error(0.04, &fine));
  CHECK(std::abs(order - 2) < 0.2);
  CHECK(coarse <= 100 * 5 + 2);  // four of gravity and one of the spring for each step
}

TEST_CASE("saved runs go on with kicks of several letters", "[integrators][kicks]") {
  const auto made = [] {
    return Simulation(planet(), compose(KineticPotential(fast_and_slow()), multiple_steps()), 0.02);
  };
  auto whole = made(), first = made(), second = made();
  REQUIRE(whole.run(40).ok());
  REQUIRE(first.run(17).ok());
  second.restore(first.save());
  REQUIRE(second.run(23).ok());
  CHECK(second.particles().positions().all() == whole.particles().positions().all());
  CHECK(second.evaluations().force == whole.evaluations().force);
}

TEST_CASE("a kick by another letter is no kick B, whatever its letter", "[integrators][kicks]") {
  for (const char letter : {'C', 'L'}) {
    CAPTURE(letter);
    ForceField<double> field;
    field.add(Gravity{.G = 1});
    field.add(AnyForce<double>(HarmonicField{.k = 1e-3}).in_kick(letter));
    Scheme only = word("BAB");  // a word of letters must have a B; schemes of programs may be any
    only.word = Word();
    for (const Stage& stage : {Stage{letter, 0.5_q}, Stage{'A', 1_q}, Stage{letter, 0.5_q}}) only.word.push_back(stage);
    CHECK_THROWS_WITH(compose(KineticPotential(field), only), Catch::Matchers::Contains("has no letter B"));
    const std::string both = {letter, 'B', 'A', 'B', letter};
    CHECK_NOTHROW(compose(KineticPotential(field), word(both)));
  }
}

TEST_CASE("a Hamiltonian with kicks of one letter refuses forces of others", "[integrators][kicks]") {
  ForceField<double> slow;
  slow.add(AnyForce<double>(HarmonicField{.k = 1}).in_kick('C'));
  CHECK_THROWS_AS(compose(WisdomHolman({.G = 1}, slow), schemes::verlet), SchemeMismatch);
}

}  // namespace noether

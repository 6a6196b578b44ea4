/// What correctors and kernels do for the outer planets: energy errors of some hundred years, by steps of 200 days.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gr_potential.hpp"
#include "forces/gravity.hpp"
#include "forces/oblateness.hpp"
#include "forces/post_newtonian.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/wisdom_holman.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/settings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace noether {
namespace {

constexpr double step = 200;

Simulation<double> planets(const Scheme& scheme, const CompositionOptions& options = {},
                           Coordinates coordinates = Coordinates::jacobi) {
  const auto arcs = test::wisdom_holman({.G = test::outer_G, .coordinates = coordinates});
  return Simulation<double>(test::outer_planets(), compose(arcs, scheme, options), step);
}

/// The largest relative energy error of 500 years, looked at every ten steps.
double worst(Simulation<double> simulation) {
  auto& energy = simulation.every(10, Energy());
  REQUIRE(simulation.run(910).ok());
  return *energy.report().worst;
}

TEST_CASE("a corrector takes three orders of magnitude off the error of the energy, a kernel one more", "[corrector]") {
  const double plain = worst(planets(schemes::verlet_aba));
  const double corrected = worst(planets(schemes::verlet_aba, {.corrector = 17}));
  CHECK(plain > 1e-6);
  CHECK(corrected < plain / 300);
  for (const StepKernel kernel : {StepKernel::modified, StepKernel::composed, StepKernel::lazy}) {
    CAPTURE(static_cast<int>(kernel));
    CHECK(worst(planets(schemes::verlet_aba, {.corrector = 17, .kernel = kernel})) < corrected / 8);
  }
  const double gradient = worst(planets(schemes::saba_4, {.kernel = StepKernel::modified}));
  CHECK(gradient < worst(planets(schemes::saba_4)) / 8);
  for (const Coordinates coordinates : {Coordinates::democratic, Coordinates::whds, Coordinates::barycentric}) {
    CAPTURE(static_cast<int>(coordinates));
    CHECK(worst(planets(schemes::verlet_aba, {.corrector = 17}, coordinates)) <
          worst(planets(schemes::verlet_aba, {}, coordinates)) / 30);
  }
}

TEST_CASE("a corrector keeps the order of 'verlet' where a force depends on time", "[corrector]") {
  const auto end = [](const CompositionOptions& options, double h) {
    const auto arcs = test::wisdom_holman(
        {.G = test::outer_G}, OscillatingField{.acceleration = {1e-7, 2e-7, 0}, .omega = 2e-3, .phase = 0.3});
    Simulation<double> run(test::outer_planets(), compose(arcs, schemes::verlet, options), h);
    REQUIRE(run.run(std::llround(8000 / h)).ok());
    return run.particles();
  };
  const auto truth = end({.corrector = 5}, 5);
  const auto error = [&](const CompositionOptions& options, double h) {
    const auto s = end(options, h);
    double worst = 0;
    for (Index i = 0; i < s.size(); ++i)
      worst = std::max(worst, std::sqrt(norm2(Vec3<double>(s.positions()[i] - truth.positions()[i]))));
    return worst;
  };
  const double coarse = error({.corrector = 5}, 160), fine = error({.corrector = 5}, 80);
  CHECK(coarse / fine > 3.5);  // a corrector that leaves drifts out of the time makes it 2
  CHECK(coarse < error({}, 160));
}

/// Keeps the times at which it is asked.
struct CorrectorClock {
  std::vector<double>* times;
  static ForceClaims claims() { return {.time_dependent = true}; }
  std::string name() const { return "clocked"; }
  void add_to(ForceSink<double>& /*out*/, const ParticleSystem<double>& s) const { times->push_back(s.clock().time()); }
};

TEST_CASE("forces see the time of their place in the words around a run", "[corrector]") {
  std::vector<double> times;
  const WisdomHolman<double, CorrectorClock> arcs({.G = test::outer_G}, CorrectorClock{&times});
  Simulation<double> simulation(test::outer_planets(), compose(arcs, schemes::verlet_aba, {.corrector = 3}), step);
  REQUIRE(simulation.run(1).ok());
  // Z(-a, b) Z(a, b) of the corrector, whose kicks at a are one, then the kick in the middle of the step.
  const double a = std::sqrt(7.0 / 40) * step;
  REQUIRE(times.size() >= 4);
  const double expected[] = {-a, a, -a, step / 2};
  for (std::size_t k = 0; k < 4; ++k) CHECK(std::fabs(times[k] - expected[k]) < 1e-9);
  times.clear();
  simulation.particles();  // the word after the run, from the end of the step
  REQUIRE(times.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) CHECK(std::fabs(times[k] - step - expected[k]) < 1e-9);
}

TEST_CASE("a weak force beside the planets does not spoil a corrector", "[corrector]") {
  const auto with_gr = [](const CompositionOptions& options) {
    const auto arcs = test::wisdom_holman({.G = test::outer_G}, GrPotential{.c = 17.3, .G = test::outer_G});
    return worst(Simulation<double>(test::outer_planets(), compose(arcs, schemes::verlet_aba, options), step));
  };
  CHECK(with_gr({.corrector = 17}) < with_gr({}) / 300);
  for (const StepKernel kernel : {StepKernel::lazy, StepKernel::modified})
    CHECK(with_gr({.corrector = 17, .kernel = kernel}) < with_gr({.corrector = 17}) / 8);
}

TEST_CASE("kernels cost the evaluations of forces that they are said to cost", "[corrector]") {
  // Beside a force that is not in lanes: kicks in lanes keep their accelerations to themselves.
  const auto of_step = [](const Scheme& scheme, const CompositionOptions& options) {
    const auto arcs = test::wisdom_holman({.G = test::outer_G}, Oblateness{.J2 = 1e-7, .radius = 0.005});
    Simulation<double> run(test::outer_planets(), compose(arcs, scheme, options), step);
    REQUIRE(run.run(5).ok());
    const std::int64_t before = run.evaluations().force;
    REQUIRE(run.run(10).ok());
    return static_cast<double>(run.evaluations().force - before) / 10;
  };
  CHECK(of_step(schemes::verlet_aba, {}) == 1);
  CHECK(of_step(schemes::verlet_aba, {.kernel = StepKernel::modified}) == 2);
  CHECK(of_step(schemes::verlet_aba, {.corrector = 7, .kernel = StepKernel::modified}) == 2);
  CHECK(of_step(schemes::verlet_aba, {.kernel = StepKernel::lazy}) == 2);
  CHECK(of_step(schemes::verlet_aba, {.kernel = StepKernel::composed}) == 5);
  CHECK(of_step(schemes::saba_2, {.kernel = StepKernel::modified}) == 4);
}

TEST_CASE("observers change neither the bits nor the cost of a modified kernel, nor do threads", "[corrector]") {
  const auto made = [](const Scheme& scheme, int threads, std::int64_t cadence) {
    const test::Threads setting(threads);
    // Beside this force planets go letter by letter, so that accelerations of a kick are known to the kernel behind it.
    const auto arcs = test::wisdom_holman({.G = test::outer_G}, Oblateness{.J2 = 1e-7, .radius = 0.005});
    Simulation<double> run(test::planets_with_tracers(600), compose(arcs, scheme, {.kernel = StepKernel::modified}),
                           step);
    if (cadence > 0) run.every(cadence, Energy());
    REQUIRE(run.run(30).ok());
    return std::pair(run.particles(), run.evaluations().force);
  };
  for (const Scheme* scheme : {&schemes::verlet_aba, &schemes::saba_3}) {
    const auto [alone, cost] = made(*scheme, 1, 0);
    for (const int threads : {1, 2, 3}) {
      const auto [other, same_cost] = made(*scheme, threads, threads);
      CHECK(test::same_bits(alone, other));
      CHECK(cost == same_cost);
    }
  }
}

/// A force without derivatives.
struct InDoubles {
  std::string name() const { return "in_doubles"; }
  void add_to(ForceSink<double>& /*out*/, const ParticleSystem<double>& /*s*/) const {}
};

TEST_CASE("kernels that a splitting does not have are refused, with those that it has", "[corrector]") {
  const auto refusal = [](AnyHamiltonian<double> hamiltonian, const CompositionOptions& options,
                          const Scheme& scheme = schemes::verlet_aba) -> std::string {
    try {
      compose(std::move(hamiltonian), scheme, options);
    } catch (const SchemeMismatch& mismatch) {
      return mismatch.message();
    }
    return "";
  };
  const CompositionOptions modified{.corrector = 5, .kernel = StepKernel::modified},
      lazy{.corrector = 5, .kernel = StepKernel::lazy}, composed{.corrector = 5, .kernel = StepKernel::composed};
  for (const CompositionOptions& options : {modified, lazy, composed}) {
    CHECK(refusal(test::wisdom_holman({}, GrPotential{}), options) == "");
    CHECK(refusal(test::wisdom_holman({}, Oblateness{.J2 = 1e-3, .radius = 0.01}, GrPotential{}), options) == "");
  }
  CHECK(refusal(test::wisdom_holman({}, GrPotential{}, InDoubles{}), modified) ==
        "kernel = \"modified\" is not for this 'wisdom_holman', because the force 'in_doubles' is written for doubles "
        "only and has no derivatives; use kernel = \"lazy\" or \"composed\"");
  CHECK(refusal(test::wisdom_holman({}, InDoubles{}), lazy) == "");
  for (const auto& [options, name] : {std::pair(modified, "modified"), std::pair(lazy, "lazy")}) {
    CHECK(
        refusal(test::wisdom_holman({}, GrPotential{}, PostNewtonian{}), options) ==
        "kernel = \"" + std::string(name) +
            "\" is not for this 'wisdom_holman', because the force 'post_newtonian' depends on velocities; use kernel "
            "= \"composed\"");
    CHECK(
        refusal(test::wisdom_holman({.coordinates = Coordinates::whds}), options) ==
        "kernel = \"" + std::string(name) +
            "\" is not for this 'wisdom_holman', because kernels of modified kicks need Jacobi coordinates; use kernel "
            "= \"composed\"");
  }
  CHECK(refusal(test::wisdom_holman({.coordinates = Coordinates::whds}), composed) == "");
  CHECK(refusal(test::wisdom_holman({}, PostNewtonian{}), composed) == "");
  CHECK(refusal(test::wisdom_holman({.coordinates = Coordinates::democratic}), {.kernel = StepKernel::modified},
                schemes::saba_2) ==
        "kernel = \"modified\" is not for this 'wisdom_holman', because kernels of modified kicks need Jacobi "
        "coordinates; take it out");
  CHECK(refusal(test::kinetic_potential(Gravity{}), composed) ==
        "corrector = 5, kernel = \"composed\" is for kicks between Kepler arcs, but 'kinetic_potential' has none; use "
        "the "
        "Hamiltonian 'wisdom_holman', or take it out");
}

TEST_CASE("words that would kick for more than a step, by letters of kernels, are refused", "[corrector]") {
  const auto refusal = [](AnyHamiltonian<double> hamiltonian, const Scheme& scheme) -> std::string {
    try {
      compose(std::move(hamiltonian), scheme);
    } catch (const SchemeMismatch& mismatch) {
      return mismatch.message();
    }
    return "";
  };
  const auto arcs = test::wisdom_holman({});
  CHECK(refusal(arcs, word("BALAB")) ==
        "the kicks B and L of scheme 'BALAB' over 'wisdom_holman' are 2 steps long in all, where 1 is expected: L is a "
        "kick in the place of B; use kernel = \"lazy\"");
  CHECK(refusal(arcs, word("BAGAB")) == "");  // a step and a term of order 2
  CHECK(refusal(test::kinetic_potential(Gravity{}), word("BAGAB")) ==
        "scheme 'BAGAB' uses the letter G, but 'kinetic_potential' has only AB");
  CHECK(refusal(test::wisdom_holman({.coordinates = Coordinates::democratic}), word("BAGAB")) ==
        "scheme 'BAGAB' uses the letter G, but 'wisdom_holman' has only AB");
  ForceField<double> slow;
  slow.add(Gravity{}).add(AnyForce<double>(UniformField{}).in_kick('G'));
  const Scheme modified = processed(schemes::verlet_aba, {.kernel = StepKernel::modified});
  CHECK(refusal(test::kinetic_potential_over(slow), modified) ==
        "the kicks G of scheme 'verlet_aba' over 'kinetic_potential' are 0.0416667 steps long in all, where 1 is "
        "expected");
  CHECK(refusal(test::kinetic_potential_over(slow), word("GBABG")) == "");
}

}  // namespace
}  // namespace noether

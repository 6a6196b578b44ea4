/// What correctors and kernels do for the outer planets: energy errors of some hundred years, by steps of 200 days.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gr_potential.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/wisdom_holman.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

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
  template <class Real> void add_to(ForceSink<Real>& /*out*/, const ParticleSystem<Real>& s) const {
    times->push_back(static_cast<double>(s.clock().time()));
  }
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
  CHECK(with_gr({.corrector = 17, .kernel = StepKernel::lazy}) < with_gr({.corrector = 17}) / 8);
}

TEST_CASE("kernels that a splitting does not have are refused, with those that it has", "[corrector]") {
  const auto refusal = [](AnyHamiltonian<double> hamiltonian, const CompositionOptions& options) -> std::string {
    try {
      compose(std::move(hamiltonian), schemes::verlet_aba, options);
    } catch (const SchemeMismatch& mismatch) {
      return mismatch.message();
    }
    return "";
  };
  const CompositionOptions modified{.corrector = 5, .kernel = StepKernel::modified},
      lazy{.corrector = 5, .kernel = StepKernel::lazy}, composed{.corrector = 5, .kernel = StepKernel::composed};
  CHECK(refusal(test::wisdom_holman({}, GrPotential{}), modified) ==
        "kernel = \"modified\" is for wisdom_holman in Jacobi coordinates without other forces, not for this "
        "'wisdom_holman'; use kernel = \"lazy\" or \"composed\"");
  CHECK(refusal(test::wisdom_holman({}, GrPotential{}), lazy) == "");
  CHECK(refusal(test::wisdom_holman({.coordinates = Coordinates::whds}), lazy) ==
        "kernel = \"lazy\" is for wisdom_holman in Jacobi coordinates, not for this 'wisdom_holman'; use kernel = "
        "\"plain\"");
  CHECK(refusal(test::wisdom_holman({.coordinates = Coordinates::whds}), composed) == "");
  CHECK(refusal(test::kinetic_potential(Gravity{}), composed) ==
        "corrector = 5, kernel = \"composed\" is for kicks between Kepler arcs, but 'kinetic_potential' has none; use "
        "the "
        "Hamiltonian 'wisdom_holman', or take it out");
}

}  // namespace
}  // namespace noether

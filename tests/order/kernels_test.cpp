/// Correctors and kernels of heavy planets: the order that is claimed over a Hamiltonian is the one that is measured.

#include "forces/gr_potential.hpp"
#include "forces/oblateness.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/problems.hpp"

#include <cmath>
#include <vector>

namespace noether {
namespace {

using namespace noether::test;

constexpr double span_of_kernels = 1.5;

ParticleSystem<Quad> heavy_planets() { return planets(0.2, 2).as<Quad>(); }

/// The other splitting of the same Hamiltonian, into kinetic and potential energy, in steps short enough.
template <class... Fs> ParticleSystem<Quad> in_short_steps(const Fs&... forces) {
  const auto hamiltonian = kinetic_potential<Quad>(Gravity{}, forces...);
  return run(hamiltonian, schemes::sofroniou_spaletta_10_s35, heavy_planets(), span_of_kernels / 384, 384);
}

double measured(const AnyHamiltonian<Quad>& hamiltonian, const Scheme& scheme, const CompositionOptions& options,
                const ParticleSystem<Quad>& exact) {
  std::vector<ErrorPoint> points;
  for (const long n : ladder(32, 192)) {
    const double dt = span_of_kernels / static_cast<double>(n);
    points.push_back({dt, distance(run(hamiltonian, scheme, heavy_planets(), dt, n, options), exact)});
  }
  const auto used = finest(points, 1e-15, 1e-2);
  INFO(to_text(points));
  CHECK(used.size() == 3);
  return fitted_slope(used);
}

TEST_CASE("the composed kernel has the order that it claims over each kind of coordinates", "[order][slow]") {
  const auto exact = in_short_steps();
  const CompositionOptions options{.corrector = 7, .kernel = StepKernel::composed};
  const auto check = [&](Coordinates coordinates, int order) {
    CAPTURE(static_cast<int>(coordinates));
    const auto arcs = wisdom_holman<Quad>({.coordinates = coordinates});
    CHECK(compose(arcs, schemes::verlet_aba, options).claims().order == order);
    CHECK(std::fabs(measured(arcs, schemes::verlet_aba, options, exact) - order) < 0.25);
  };
  check(Coordinates::jacobi, 4);
  check(Coordinates::democratic, 3);
  check(Coordinates::whds, 2);
  check(Coordinates::barycentric, 2);
}

TEST_CASE("kernels keep their order beside strong forces, by the derivatives of these", "[order][slow]") {
  const GrPotential relativity{.c = 10};
  const Oblateness oblate{.J2 = 0.02, .J4 = -0.01, .radius = 0.3, .axis = {0.1, 0.2, 1}};
  const HarmonicField field{.k = 0.05};
  const auto exact = in_short_steps(relativity, oblate, field);
  const auto arcs = wisdom_holman<Quad>({}, relativity, oblate, field);
  const auto check = [&](const Scheme& scheme, const CompositionOptions& options) {
    INFO(scheme.name << " with " << options.processing_text());
    CHECK(compose(arcs, scheme, options).claims().order == 4);
    CHECK(std::fabs(measured(arcs, scheme, options, exact) - 4) < 0.25);
  };
  for (const StepKernel kernel : {StepKernel::modified, StepKernel::composed, StepKernel::lazy})
    check(schemes::verlet_aba, {.corrector = 7, .kernel = kernel});
  check(schemes::saba_2, {.kernel = StepKernel::modified});
  check(schemes::saba_3, {.kernel = StepKernel::modified});
}

}  // namespace
}  // namespace noether

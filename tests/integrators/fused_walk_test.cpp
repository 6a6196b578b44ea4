/// A Hamiltonian's own walk over whole steps has the bits of the letters one by one, and their count of work.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/planets.hpp"

namespace noether {
namespace {

/// The same Hamiltonian without a walk of its own.
template <class H> struct Lettered : H {
  explicit Lettered(H hamiltonian) : H(std::move(hamiltonian)) {}
  template <class... Arguments> void run(const Arguments&...) = delete;
};

struct Ended {
  ParticleSystem<double> seen;
  SavedState raw;
  std::int64_t forces;
};

bool operator==(const Ended& a, const Ended& b) {
  return test::same_bits(a.seen, b.seen) && a.raw == b.raw && a.forces == b.forces;
}

/// Where a run of 23 steps in pieces ends, watched so often.
template <class H> Ended end_of(const H& hamiltonian, const Scheme& scheme, bool compensated, std::int64_t cadence) {
  Simulation run(test::outer_planets(), compose(hamiltonian, scheme, {.compensated = compensated}), 50.0);
  if (cadence > 0) run.every(cadence, Energy{});
  for (const std::int64_t piece : {1, 2, 20}) CHECK(run.run(piece).ok());
  return {run.particles(), run.save().particles, run.evaluations().force};
}

template <class H> void check_walk(const H& hamiltonian) {
  for (const Scheme* scheme : schemes::all()) {
    CAPTURE(scheme->name);
    for (const bool compensated : {false, true}) {
      const Ended letters = end_of(Lettered<H>(hamiltonian), *scheme, compensated, 0);
      CHECK(end_of(hamiltonian, *scheme, compensated, 0) == letters);
      CHECK(end_of(hamiltonian, *scheme, compensated, 1) == letters);
      CHECK(end_of(hamiltonian, *scheme, compensated, 7) == letters);
    }
  }
}

TEST_CASE("the fused walk has the bits of the letters one by one", "[composition][fused]") {
  check_walk(KineticPotential(Gravity{.G = test::outer_G}));
}

TEST_CASE("the fused walk gives forces the stage times of the letters", "[composition][fused]") {
  check_walk(KineticPotential(
      Sum(Gravity{.G = test::outer_G}, OscillatingField{.acceleration = {1e-6, 0, 2e-6}, .omega = 0.01, .phase = 1})));
}

TEST_CASE("the fused walk ends after a step when it is asked to", "[composition][fused]") {
  const std::atomic<bool> now{true};
  ParticleSystem<double> s = test::outer_planets();
  auto integrator = compose(KineticPotential(Gravity{.G = test::outer_G}), schemes::verlet);
  s.clock() = Clock<double>::fixed(0, 10);
  integrator.bind(s);
  CHECK(integrator.advance(s, {.steps = 5, .stop = &now}).steps == 1);
  CHECK(s.clock().step() == 1);
}

}  // namespace
}  // namespace noether

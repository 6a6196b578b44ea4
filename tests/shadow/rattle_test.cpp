/// The shadow of constrained motion.

#include "monitors/monitors.hpp"
#include "tests/shadow/support.hpp"
#include "tests/support/mechanisms.hpp"

#include <cmath>

using namespace noether;
using Catch::Matchers::StartsWith;

namespace {

/// Slopes of log2 of the fluctuation from one step to half of it, for each order.
std::vector<double> rattle_slopes(const test::Mechanism& mechanism, const Scheme& scheme, double h,
                                  std::int64_t steps) {
  const auto integrator = compose(test::hamiltonian_of<Quad>(mechanism), scheme);
  const auto coarse = test::shadow_of(integrator, mechanism.particles, h, steps, test::shadow_orders);
  const auto fine = test::shadow_of(integrator, mechanism.particles, h / 2, 2 * steps, test::shadow_orders);
  std::vector<double> result;
  for (std::size_t k = 0; k < test::shadow_orders.size(); ++k) {
    result.push_back(std::log2(coarse.fluctuation(k) / fine.fluctuation(k)));
  }
  return result;
}

}  // namespace

TEST_CASE("the shadow Hamiltonian is flat to its order under RATTLE and its compositions", "[shadow][constraints]") {
  struct Case {
    test::Mechanism mechanism;
    Scheme scheme;
    double h;
  };
  for (const Case& one : {Case{test::spherical_pendulum(), schemes::verlet, 0.02},
                          Case{test::spherical_pendulum(), schemes::yoshida_4, 0.02},
                          Case{test::double_pendulum(), schemes::verlet, 0.0125}}) {
    CAPTURE(one.scheme.name, one.mechanism.particles.size());
    const auto found = rattle_slopes(one.mechanism, one.scheme, one.h, 120);
    CAPTURE(found);
    CHECK(std::fabs(found[0] - 4) < 0.2);
    CHECK(std::fabs(found[1] - 8) < 0.2);
    for (std::size_t k = 1; k < found.size(); ++k) CHECK(found[k] > found[k - 1] + 2);
    CHECK(found.back() > 20);
  }
}

TEST_CASE("in doubles the shadow of a double pendulum is flatter than its energy by many orders",
          "[shadow][constraints]") {
  const test::Mechanism mechanism = test::double_pendulum();
  Simulation simulation(mechanism.particles, compose(test::hamiltonian_of(mechanism), schemes::verlet), 0.005);
  auto& shadow = simulation.every(1, ShadowHamiltonian<>());
  auto& energy = simulation.every(1, Energy{});
  REQUIRE(simulation.run(4000).ok());
  CHECK(shadow.fluctuation(5) < 1e-8 * energy.rms());
  CHECK_THAT(shadow.verdict(), StartsWith("kept"));
}

TEST_CASE("constraints that are not converged are named, with what the shadow shows of them", "[shadow][constraints]") {
  double before = 1;
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    const test::Mechanism chain = test::hanging_chain(3, {.solver = ConstraintMethod::rattle, .tolerance = tolerance});
    const auto shadow = test::shadow_of(compose(test::hamiltonian_of(chain), schemes::verlet), chain.particles, 0.01,
                                        2000, test::shadow_orders);
    CAPTURE(tolerance, shadow.verdict());
    CHECK_THAT(shadow.verdict(), StartsWith(fmt::format("constraints not converged: they are solved to {:.1e}, and no "
                                                        "order fluctuates less than ",
                                                        tolerance)));
    const double least = shadow.fluctuation(5);
    CHECK(least < 0.1 * before);
    before = least;
  }
  const test::Mechanism converged = test::hanging_chain(3);
  const auto shadow = test::shadow_of(compose(test::hamiltonian_of(converged), schemes::verlet), converged.particles,
                                      0.01, 2000, test::shadow_orders);
  CHECK_THAT(shadow.verdict(), StartsWith("kept"));
  CHECK(shadow.fluctuation(5) < 1e-3 * before);
}

TEST_CASE("steps too large for a mechanism are named, not taken for a method that is not symplectic",
          "[shadow][constraints]") {
  const auto verdict_of = [](const test::Mechanism& mechanism, const Scheme& scheme, double h) {
    return test::shadow_of(compose(test::hamiltonian_of(mechanism), scheme), mechanism.particles, h, 4000,
                           test::shadow_orders)
        .verdict();
  };
  for (const double h : {0.25, 0.3}) {
    CHECK_THAT(verdict_of(test::spherical_pendulum(), schemes::verlet, h), StartsWith("step too large"));
  }
  for (const double h : {0.03, 0.05}) {
    CHECK_THAT(verdict_of(test::double_pendulum(), schemes::verlet, h), StartsWith("step too large"));
    CHECK_THAT(verdict_of(test::double_pendulum(), schemes::kahan_li_6_s9, h), StartsWith("step too large"));
  }
}

namespace {
/// Weight and a swirl that no potential has.
struct SwirlingWeight {
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    test::weight.add_to(out, s);
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> q = s.positions()[i];
      out.acceleration(i, Real(1e-3) * Vec3<Real>(-q[1], q[0], Real(0)));
    }
  }
};
}  // namespace

TEST_CASE("a force that is no gradient is named under constraints too", "[shadow][constraints]") {
  const test::Mechanism mechanism = test::spherical_pendulum();
  const auto shadow = test::shadow_of(compose(test::hamiltonian_of(mechanism, SwirlingWeight{}), schemes::verlet),
                                      mechanism.particles, 0.01, 2000, test::shadow_orders);
  CHECK_THAT(shadow.verdict(), StartsWith("force is not a gradient"));
}

/// Projections at the extremes: orbits of e = 0.999 and a head-on fall, right or by a named outcome.

#include "forces/gravity.hpp"
#include "integrators/projected.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/kepler_pair.hpp"

namespace noether {

TEST_CASE("an orbit of e = 0.999 is held on its energy and angular momentum", "[extremes][projections]") {
  AnyIntegrator<double> dop853 = test::classical_over(Gravity{}, method("dop853", {.rtol = 1e-8}));
  const auto run = [&](bool project) {
    AnyIntegrator<double> integrator = dop853;
    if (project) {
      integrator = projected(dop853, {.onto = {Invariant::energy, Invariant::angular_momentum}, .time_scale = 1});
    }
    Simulation<double> sim(test::kepler_pair(0.999), std::move(integrator));
    auto& energy = sim.every(1, Energy());
    const Outcome outcome = sim.run_until(3 * test::turn);
    INFO(outcome.message);
    REQUIRE(outcome.ok());
    return std::pair(energy.worst(), test::error_after_turns(sim.particles(), 0.999));
  };
  const auto [bare_energy, bare_error] = run(false);
  const auto [energy, error] = run(true);
  CAPTURE(bare_energy, bare_error, energy, error);
  CHECK(energy < 1e-11);  // of 1000 times as much at the pericenter
  CHECK(bare_energy > 10 * energy);
  CHECK(error < bare_error);
}

TEST_CASE("a fall without angular momentum is projected, or ends by name", "[extremes][projections]") {
  ParticleSystem<double> s;
  s.add("one", 0.5, {-0.5, 0, 0}, {0, 0, 0});
  s.add("other", 0.5, {0.5, 0, 0}, {0, 0, 0});
  Simulation<double> sim(s,
                         projected(test::classical_over(Gravity{}, method("rk4")),
                                   {.onto = {Invariant::energy, Invariant::angular_momentum}}),
                         0.01);
  const Outcome outcome = sim.run(60);  // they meet at pi / (2 sqrt 2) = 1.11
  REQUIRE(outcome.ok());
  CHECK(std::abs(test::energy_of(sim.particles()) + 0.25) < 1e-15);
  CHECK(sim.particles().positions()[0][1] == 0);
  const Outcome end = sim.run(200);
  CHECK((end.ok() || end.kind == Outcome::Kind::solver_failure || end.kind == Outcome::Kind::diverged));
}

}  // namespace noether

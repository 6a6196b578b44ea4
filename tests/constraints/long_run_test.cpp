#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/mechanisms.hpp"

#include <fmt/format.h>

namespace noether {
namespace {

using namespace noether::test;

TEST_CASE("the energy of ten links has no slope over ten million steps", "[constraints][nightly]") {
  // After a million in which they forget their start: how the energy oscillates depends on where they are, and that
  // takes its time to settle.
  constexpr std::int64_t steps = 10'000'000;
  const Mechanism chain = hanging_chain(10);
  Simulation<double> sim(chain.particles, compose(hamiltonian_of(chain), schemes::verlet), 0.002);
  REQUIRE(sim.run(1'000'000).ok());
  auto& energy = sim.every(20, Energy{});
  REQUIRE(sim.run(steps).ok());
  const MonitorReport report = energy.report();
  REQUIRE(report.slope_error);
  fmt::print("ten links, {} steps: energy slope {:.2e} +- {:.1e} per second, worst error {:.1e}, violation {:.1e}\n",
             steps, *report.slope, *report.slope_error, *report.worst,
             chain.constraints.worst(sim.particles()).residual);
  CHECK(std::fabs(*report.slope) < 3 * *report.slope_error);
  CHECK(*report.slope_error * static_cast<double>(steps) * 0.002 < 0.1 * *report.worst);
  CHECK(chain.constraints.worst(sim.particles()).residual < 16 * 0x1p-53 * 10);
}

}  // namespace
}  // namespace noether

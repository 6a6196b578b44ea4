#include "engine/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/mechanisms.hpp"

#include <fmt/format.h>

namespace noether {
namespace {

using namespace noether::test;

/// The slope of the energy of ten links over so many steps of 0.002, in units of its own error.
void check_slope(std::int64_t steps) {
  Mechanism chain;
  Vec3<double> x = Vec3<double>::Zero();
  for (Index i = 0; i < 10; ++i) {
    const double tilt = 0.4 + 0.2 * std::sin(2.0 * static_cast<double>(i)), turn = 0.3 * static_cast<double>(i);
    x += Vec3<double>(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), -std::cos(tilt));
    chain.particles.add(std::to_string(i), 1, x, {0, 0, 0});
  }
  chain.constraints.add(chain.particles, OnSphere{}, {0});
  for (Index i = 0; i < 9; ++i) chain.constraints.add(chain.particles, Distance{}, {i, i + 1});
  Simulation<double> sim(chain.particles, compose(hamiltonian_of(chain), schemes::verlet), 0.002);
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

TEST_CASE("the energy of ten links has no slope over a hundred thousand steps", "[constraints][slow]") {
  check_slope(100'000);
}

TEST_CASE("the energy of ten links has no slope over ten million steps", "[constraints][nightly]") {
  check_slope(10'000'000);
}

}  // namespace
}  // namespace noether

/// Liquids over long times: published state points, and energy that goes nowhere.

#include "engine/simulation.hpp"
#include "forces/lennard_jones.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/langevin.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/liquid.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace noether {
namespace {

LennardJonesForce switched(double cutoff, double from) {
  return {.cutoff = cutoff, .cutoff_style = Cutoff::switch_c4, .switch_from = from, .epsilon = 1.0, .sigma = 1.0};
}

struct Estimate {
  double value, error;
};

/// Mean of correlated numbers, with its error from means over 25 blocks.
Estimate mean_of(const std::vector<double>& all) {
  constexpr std::size_t blocks = 25;
  const std::size_t length = all.size() / blocks;
  double sum = 0, squares = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    double block = 0;
    for (std::size_t k = 0; k < length; ++k) block += all[b * length + k] / static_cast<double>(length);
    sum += block;
    squares += block * block;
  }
  const double mean = sum / blocks;
  return {mean, std::sqrt((squares / blocks - mean * mean) / (blocks - 1))};
}

/// Slope of correlated numbers over time, fitted to means over 25 blocks. @param span  of all of them [time]
Estimate slope_of(const std::vector<double>& all, double span) {
  constexpr std::size_t blocks = 25;
  const std::size_t length = all.size() / blocks;
  std::vector<double> means(blocks, 0.0);
  double mean = 0, times2 = 0, slope = 0, rest = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    for (std::size_t k = 0; k < length; ++k) means[b] += (all[b * length + k] - all[0]) / static_cast<double>(length);
    mean += means[b] / blocks;
  }
  const auto time = [&](std::size_t b) { return span * ((static_cast<double>(b) + 0.5) / blocks - 0.5); };
  for (std::size_t b = 0; b < blocks; ++b) {
    times2 += time(b) * time(b);
    slope += time(b) * (means[b] - mean);
  }
  slope /= times2;
  for (std::size_t b = 0; b < blocks; ++b) rest += std::pow(means[b] - mean - slope * time(b), 2);
  return {slope, std::sqrt(rest / (blocks - 2) / times2)};
}

/// What is measured of a liquid: energy of a particle, and pressure.
struct StatePoint {
  Estimate energy, pressure;
};

/// Pairs cut off at 3, with the tail beyond.
const LennardJonesForce cut{.cutoff = 3, .cutoff_style = Cutoff::plain, .tail = true, .epsilon = 1.0, .sigma = 1.0};
/// Pairs whose force is shifted to end at 3.
const LennardJonesForce shifted{.cutoff = 3, .cutoff_style = Cutoff::shifted_force, .epsilon = 1.0, .sigma = 1.0};

/// Both of these pairs; the pressure of an ideal gas is that of its temperature.
std::pair<double, double> energy_and_pressure(const LennardJonesForce& force, const ParticleSystem<double>& s,
                                              Workspace& lists, double temperature) {
  VectorColumn<double> a(s.size());
  ForceSink<double> sink(a, s, {.energy = true, .virial = true}, &lists);
  force.add_to(sink, s);
  const auto n = static_cast<double>(s.size());
  return {sink.potential() / n, (n * temperature + sink.virial().trace() / 3) / s.box().volume()};
}

/// Means of a force's energy and pressure by BAOAB. @param driving  the force that moves the particles
StatePoint state_point(const LennardJonesForce& driving, const LennardJonesForce& seen, double density,
                       double temperature, std::int64_t steps) {
  Simulation sim(
      test::liquid(5, density, temperature),
      compose(test::in_bath(test::field_of(driving), {.temperature = temperature, .friction = 0.5}), word("BAOAB")),
      0.004);
  Workspace list;
  list.put(NeighborList(3.0));
  REQUIRE(sim.run(20000).ok());
  std::vector<double> energies, pressures;
  for (std::int64_t k = 0; k < steps; k += 25) {
    REQUIRE(sim.run(25).ok());
    const auto [energy, pressure] = energy_and_pressure(seen, sim.particles(), list, temperature);
    energies.push_back(energy);
    pressures.push_back(pressure);
  }
  return {mean_of(energies), mean_of(pressures)};
}

/// What NIST's Monte Carlo found, its error beside; an error of 0 is not known.
struct PublishedPoint {
  double temperature, density;
  Estimate energy, pressure;
  double worst_error;  ///< that an energy may have
  std::int64_t steps;
};

bool agree(const Estimate& a, const Estimate& b) {
  return std::abs(a.value - b.value) < 3 * std::hypot(a.error, b.error);
}

/// Moves by a switch so narrow that it is nearly the cut: a plain cut would push nobody as it is crossed, and its
/// distribution would be that of the shifted potential.
void check_state_point(const PublishedPoint& point) {
  const StatePoint found = state_point(switched(3.0, 2.9), cut, point.density, point.temperature, point.steps);
  fmt::print("T {:.2f}, density {:.3f}: U {:.6f} +- {:.1g}, of NIST {} +- {}; p {:.6f} +- {:.1g}, of NIST {}{}\n",
             point.temperature, point.density, found.energy.value, found.energy.error, point.energy.value,
             point.energy.error, found.pressure.value, found.pressure.error, point.pressure.value,
             point.pressure.error > 0 ? fmt::format(" +- {}", point.pressure.error) : "");
  CHECK(found.energy.error < point.worst_error);
  CHECK(agree(found.energy, point.energy));
  if (point.pressure.error > 0) CHECK(agree(found.pressure, point.pressure));
}

}  // namespace

// NIST Standard Reference Simulation Website, Lennard-Jones by Monte Carlo, cut at 3 with the tail:
// tests/oracle/README.md.

TEST_CASE("BAOAB finds the energies of NIST's liquids, and their pressures", "[liquids][oracle][nightly]") {
  for (const PublishedPoint& point :
       {PublishedPoint{0.85, 0.776, {-5.5121, 4.55e-4}, {6.7714e-3, 0}, 2e-3, 500'000},
        PublishedPoint{0.90, 0.776, {-5.4689, 4.2e-4}, {0.24056, 2.74e-3}, 2e-3, 500'000}}) {
    check_state_point(point);
  }
}

TEST_CASE("BAOAB finds the energies of NIST's gases, and their pressures", "[liquids][oracle][nightly]") {
  for (const PublishedPoint& point :
       {PublishedPoint{0.85, 0.005, {-5.1901e-2, 7.53e-5}, {4.1003e-3, 5.05e-7}, 5e-4, 1'500'000},
        PublishedPoint{0.85, 0.007, {-7.2834e-2, 1.34e-4}, {5.6565e-3, 0}, 5e-4, 1'500'000},
        PublishedPoint{0.85, 0.009, {-9.3973e-2, 1.29e-4}, {7.1641e-3, 2.24e-6}, 5e-4, 1'500'000}}) {
    check_state_point(point);
  }
}

// The same source, transition-matrix Monte Carlo of a force shifted to end at 3: densities of vapour and liquid that
// live together, and their pressure. Errors do not stand there: each figure is taken to be known to half a unit of its
// last digit, and so is the density, whose share is by slopes dp/drho of T at most in vapour, 10 and 6 in the liquids,
// and dU/drho of -7.

TEST_CASE("vapour at NIST's saturated densities has NIST's vapour pressure", "[liquids][oracle][nightly]") {
  for (const auto& [temperature, density, pressure] :
       {std::array{0.70, 7.501e-3, 4.931e-3}, std::array{0.85, 3.043e-2, 2.146e-2}}) {
    const StatePoint found = state_point(shifted, shifted, density, temperature, 600'000);
    // A unit of the last digit is the same for pressure and density.
    const double digit = temperature < 0.8 ? 1e-6 : 1e-5, printed = std::hypot(0.5 * digit, 0.5 * digit * temperature);
    fmt::print("vapour at T {:.2f}, density {}: p {:.7f} +- {:.1g}, of NIST {}; U {:.6f} +- {:.1g}\n", temperature,
               density, found.pressure.value, found.pressure.error, pressure, found.energy.value, found.energy.error);
    CHECK(found.pressure.error < 2e-3 * pressure);
    CHECK(agree(found.pressure, {pressure, printed}));
  }
}

TEST_CASE("liquid at NIST's saturated densities has NIST's energy, and the vapour's pressure",
          "[liquids][oracle][nightly]") {
  const StatePoint cold = state_point(shifted, shifted, 0.7852, 0.70, 400'000);
  const StatePoint warm = state_point(shifted, shifted, 0.6981, 0.85, 400'000);
  fmt::print(
      "liquid at T 0.70, density 0.7852: U {:.5f} +- {:.1g}, of NIST -4.880; p {:.4f} +- {:.1g}, of NIST "
      "0.00493\n",
      cold.energy.value, cold.energy.error, cold.pressure.value, cold.pressure.error);
  fmt::print("liquid at T 0.85, density 0.6981: p {:.4f} +- {:.1g}, of NIST 0.02146; U {:.5f} +- {:.1g}\n",
             warm.pressure.value, warm.pressure.error, warm.energy.value, warm.energy.error);
  CHECK(cold.energy.error < 1.5e-3);
  CHECK(agree(cold.energy, {-4.880, std::hypot(5e-4, 7 * 5e-5)}));
  CHECK(warm.pressure.error < 5e-3);
  CHECK(agree(warm.pressure, {2.146e-2, 6 * 5e-5}));
  CHECK(agree(cold.pressure, {4.931e-3, 10 * 5e-5}));
}

TEST_CASE("the energy of a switched liquid goes nowhere in 250 000 steps", "[liquids][drift][nightly]") {
  constexpr double step = 0.002;
  Simulation sim(test::liquid(10, 0.8442, 1.44), compose(test::kinetic_potential(switched(2.5, 2.0)), schemes::verlet),
                 step);
  REQUIRE(sim.run(5000).ok());
  std::vector<double> energies;
  auto& energy = sim.every(100, Energy{});
  constexpr std::int64_t steps = 250'000;
  for (std::int64_t k = 0; k < steps; k += 100) {
    REQUIRE(sim.run(100).ok());
    energies.push_back(energy.total() / static_cast<double>(sim.particles().size()));
  }
  const Estimate slope = slope_of(energies, step * static_cast<double>(steps));
  CAPTURE(slope.value, slope.error);
  CHECK(std::abs(slope.value) < 3 * slope.error);
  CHECK(slope.error < 1e-8);
}

}  // namespace noether

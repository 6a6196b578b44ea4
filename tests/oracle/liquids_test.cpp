/// Liquids over long times: published state points, and energy that goes nowhere.

#include "engine/monitors.hpp"
#include "engine/simulation.hpp"
#include "forces/lennard_jones.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/langevin.hpp"
#include "integrators/schemes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/liquid.hpp"

#include <cmath>
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

/// Energy of pairs cut off at 3, with the tail beyond, for each particle.
double cut_energy(const ParticleSystem<double>& s, NeighborList& list) {
  const LennardJonesForce cut{.cutoff = 3, .cutoff_style = Cutoff::plain, .tail = true, .epsilon = 1.0, .sigma = 1.0};
  VectorColumn<double> a(s.size());
  ForceSink<double> sink(a, s, {.energy = true}, &list);
  cut.add_to(sink, s);
  return sink.potential() / static_cast<double>(s.size());
}

/// Mean energy by BAOAB under a switch so narrow that it is nearly the cut: a plain cut would push nobody as it is
/// crossed, and its distribution would be that of the shifted potential.
Estimate energy_at(int cells, double density, double temperature, std::int64_t steps) {
  Simulation sim(test::liquid(cells, density, temperature),
                 compose(Langevin(KineticPotential(switched(3.0, 2.9)), {.temperature = temperature, .friction = 0.5}),
                         word("BAOAB")),
                 0.004);
  NeighborList list(3.0);
  REQUIRE(sim.run(20000).ok());
  std::vector<double> energies;
  for (std::int64_t k = 0; k < steps; k += 25) {
    REQUIRE(sim.run(25).ok());
    energies.push_back(cut_energy(sim.particles(), list));
  }
  return mean_of(energies);
}

}  // namespace

TEST_CASE("BAOAB finds the energies of NIST's state points", "[liquids][oracle][nightly]") {
  // NIST Standard Reference Simulation Website, Lennard-Jones by Monte Carlo, cut at 3 with the tail: energy of a
  // particle and its error.
  struct Point {
    double temperature, density, energy, error;
    int cells;
    std::int64_t steps;
  };
  for (const Point& point :
       {Point{0.85, 0.776, -5.5121, 4.55e-4, 5, 1'000'000}, Point{0.90, 0.776, -5.4689, 4.2e-4, 5, 1'000'000},
        Point{0.85, 0.005, -5.1901e-2, 7.5e-5, 5, 1'500'000}}) {
    const Estimate found = energy_at(point.cells, point.density, point.temperature, point.steps);
    CAPTURE(point.temperature, point.density, point.energy, found.value, found.error);
    CHECK(found.error < 2e-3);
    CHECK(std::abs(found.value - point.energy) < 3 * std::hypot(found.error, point.error));
  }
}

TEST_CASE("the energy of a switched liquid goes nowhere in a million steps", "[liquids][drift][nightly]") {
  constexpr double step = 0.002;
  Simulation sim(test::liquid(10, 0.8442, 1.44), compose(KineticPotential(switched(2.5, 2.0)), schemes::verlet), step);
  REQUIRE(sim.run(5000).ok());
  std::vector<double> energies;
  auto& energy = sim.every(100, Energy{});
  constexpr std::int64_t steps = 1'000'000;
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

/// A patch of Saturn's rings beside REBOUND's: how warm, how full and how viscous spheres of ice become.

#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "monitors/ring_monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/ring_spheres.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

using namespace noether;

namespace {

constexpr double Omega = 1.3143527e-4;

/// The spheres that REBOUND began with, too; in a patch that is cut elsewhere, which soon is another history.
/// @param shift  along the motion [m]
ParticleSystem<double> spheres_of_file(double shift) {
  std::ifstream file(NOETHER_SOURCE_DIR "/tests/data/rings/spheres.csv");
  ParticleSystem<double> s(unit_system("reduced"));
  std::vector<double> radii;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::array<double, 7> row{};
    std::istringstream numbers(line);
    char comma = 0;
    for (double& number : row) numbers >> number >> comma;
    radii.push_back(row[0]);
    const double volume = 4 * std::numbers::pi / 3 * row[0] * row[0] * row[0];
    s.add("", 400 * volume, {row[1], row[2] + shift, row[3]}, {row[4], row[5], row[6]});
  }
  auto& column = s.add_column<BodyRadius>();
  for (Index i = 0; i < s.size(); ++i) column[i] = radii[static_cast<std::size_t>(i)];
  s.set_box(Box::periodic({100, 100, 400}));
  return s;
}

struct Mean {
  double value, error;
};

/// Of ten blocks: where these are longer than what is correlated, the error is that of independent numbers.
Mean mean_of(const std::vector<double>& all) {
  constexpr std::size_t blocks = 10;
  std::array<double, blocks> means{};
  for (std::size_t k = 0; k < blocks; ++k) {
    const std::size_t from = k * all.size() / blocks, to = (k + 1) * all.size() / blocks;
    for (std::size_t i = from; i < to; ++i) means[k] += all[i] / static_cast<double>(to - from);
  }
  double mean = 0, squares = 0;
  for (const double one : means) mean += one / blocks;
  for (const double one : means) squares += (one - mean) * (one - mean);
  return {mean, std::sqrt(squares / blocks / (blocks - 1))};
}

/// Dispersion of velocities, filling factor, local and collisional viscosity.
using Means = std::array<Mean, 4>;

/// Of 387 spheres of 1 to 4 m with the restitution of Bridges 1984, over orbits 20 to 50 in steps of a thousandth.
/// @param runs  whose orbits are taken together
template <class... Fs> Means means_of_rings(int runs, Fs... forces) {
  std::array<std::vector<double>, 4> series;
  for (int run = 0; run < runs; ++run) {
    Simulation<double> sim(spheres_of_file(37.0 * run),
                           compose(test::sheet_of_spheres({.Omega = Omega},
                                                          {.restitution = 0.32,
                                                           .restitution_exponent = -0.234,
                                                           .restitution_speed = 0.01,
                                                           .minimum_rebound = 1.3e-7},
                                                          forces...),
                                   schemes::verlet_aba),
                           2e-3 * std::numbers::pi / Omega);
    auto& dispersion = sim.every(100, VelocityDispersion(Omega));
    auto& filling = sim.every(100, FillingFactor{});
    auto& viscosity = sim.every(100, Viscosity(Omega));
    REQUIRE(sim.run(20000).ok());
    for (int k = 0; k < 300; ++k) {
      REQUIRE(sim.run(100).ok());
      const std::array<double, 4> now = {dispersion.value(), filling.value(), viscosity.local(),
                                         viscosity.collisional()};
      for (std::size_t q = 0; q < now.size(); ++q) series[q].push_back(now[q]);
    }
  }
  return {mean_of(series[0]), mean_of(series[1]), mean_of(series[2]), mean_of(series[3])};
}

/// Differ by at most three errors, none of which is more than 5 % of its mean.
void check_beside(const Means& ours, const Means& theirs) {
  for (std::size_t q = 0; q < ours.size(); ++q) {
    INFO("quantity " << q << ": " << ours[q].value << " +- " << ours[q].error);
    CHECK(ours[q].error <= 0.05 * ours[q].value);
    CHECK(std::abs(ours[q].value - theirs[q].value) <= 3 * std::hypot(ours[q].error, theirs[q].error));
  }
}

}  // namespace

// REBOUND's means and errors of ten blocks: tests/data/rings/README.md.
TEST_CASE("a patch of ice spheres becomes what it does in REBOUND", "[oracle][ring][slow]") {
  check_beside(means_of_rings(1),
               {Mean{1.2828e-3, 1.2e-5}, {0.11272, 8.2e-4}, {2.3768e-4, 6.2e-6}, {1.3866e-4, 2.7e-6}});
}

TEST_CASE("a patch of ice spheres that attract each other, through nine images, becomes what it does in REBOUND",
          "[oracle][ring][nightly]") {
  // Wakes come and go: of thirty orbits the local viscosity has an error of 6 %, so there are two runs.
  check_beside(means_of_rings(2, Gravity{.G = 6.6743e-11, .softening = 0.1}),
               {Mean{1.9288e-3, 3.6e-5}, {0.11946, 1.9e-3}, {1.1707e-3, 4.9e-5}, {5.1037e-4, 1.4e-5}});
}

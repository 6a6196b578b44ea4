/// The chain of Fermi, Pasta and Ulam with three stiff springs (Hairer, Lubich, Wanner 2006, I.5): energy goes from the
/// first spring to the third, right or wrong, while the energy of the chain tells nothing of it.

#include "forces/fermi_pasta_ulam.hpp"
#include "engine/simulation.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

using namespace noether;

namespace {

constexpr double omega = 50, end = 200;
constexpr int looks = 200;
const FermiPastaUlam chain{.k = omega * omega / 2};

/// In the book's coordinates: slow x0_1 = 1, y0_1 = 1, fast x1_1 = 1/omega, y1_1 = 1, all others 0.
ParticleSystem<double> start() {
  const double root = std::sqrt(0.5);
  ParticleSystem<double> s;
  s.add("left 1", 1, {(1 - 1 / omega) * root, 0, 0}, {0, 0, 0});
  s.add("right 1", 1, {(1 + 1 / omega) * root, 0, 0}, {std::sqrt(2.0), 0, 0});
  for (int k = 0; k < 4; ++k) s.add("", 1, {0, 0, 0}, {0, 0, 0});
  return s;
}

/// Oscillatory energies I_1, I_2, I_3 of the stiff springs.
std::array<double, 3> oscillatory_energies(const ParticleSystem<double>& s) {
  std::array<double, 3> energies{};
  for (Index j = 0; j < 3; ++j) {
    const double x = (s.positions()[2 * j + 1][0] - s.positions()[2 * j][0]) * std::sqrt(0.5);
    const double y = (s.velocities()[2 * j + 1][0] - s.velocities()[2 * j][0]) * std::sqrt(0.5);
    energies[static_cast<std::size_t>(j)] = (y * y + omega * omega * x * x) / 2;
  }
  return energies;
}

struct Exchange {
  std::vector<std::array<double, 3>> energies;  ///< at times 1, 2, ...
  double error = 0;                             ///< largest, of the energy of the chain
};

Exchange exchange(Simulation<double> run) {
  const Energy& energy = run.every_time(end / looks, Energy{});
  Exchange found;
  for (int k = 1; k <= looks; ++k) {
    REQUIRE(run.run_until(end * k / looks).ok());
    found.energies.push_back(oscillatory_energies(run.particles()));
  }
  found.error = energy.worst();
  return found;
}

Exchange exchange(const Scheme& scheme, double step) {
  return exchange(Simulation<double>(start(), compose(test::kinetic_potential(chain), scheme), step));
}

/// Of the energy of a spring, over the second half of a run.
double mean(const Exchange& run, std::size_t spring) {
  double sum = 0;
  for (std::size_t k = looks / 2; k < looks; ++k) sum += run.energies[k][spring];
  return sum / (looks / 2.0);
}

/// Largest difference of the mean energies of a spring.
double apart(const Exchange& a, const Exchange& b) {
  double worst = 0;
  for (std::size_t j = 0; j < 3; ++j) worst = std::max(worst, std::abs(mean(a, j) - mean(b, j)));
  return worst;
}

/// Largest distance of I_1 + I_2 + I_3 from the 1 at the start.
double total_strays(const Exchange& run) {
  double worst = 0;
  for (const auto& one : run.energies) worst = std::max(worst, std::abs(one[0] + one[1] + one[2] - 1));
  return worst;
}

}  // namespace

TEST_CASE("stiff springs trade energy as the exact flow does at small steps, and otherwise at large ones", "[oracle]") {
  const Exchange truth =
      exchange(Simulation<double>(start(), test::classical_over(chain, method("dop853", {.rtol = 1e-11}))));
  CHECK(total_strays(truth) < 3 / omega);
  CHECK(mean(truth, 0) < 0.05);  // of the 1 it had, the first spring has given nearly all to the third
  CHECK(mean(truth, 2) > 0.8);

  for (const double h : {0.001, 0.002}) {
    const Exchange verlet = exchange(schemes::verlet, h), sixth = exchange(schemes::blanes_moan_s6, h);
    CHECK(apart(verlet, truth) < 15 * h);
    CHECK(apart(sixth, truth) < 1e-6);
    CHECK(total_strays(verlet) < 4 / omega);
  }

  // h omega = 1.25: the energy of the chain is bounded, and goes to the wrong springs.
  const double h = 0.025;
  const Exchange verlet = exchange(schemes::verlet, h), euler = exchange(schemes::symplectic_euler_a, h);
  const Exchange midpoint = exchange(
      Simulation<double>(start(), test::classical_over(chain, method("implicit_midpoint", {.adaptive = false})), h));
  for (const Exchange* run : {&verlet, &euler, &midpoint}) {
    CHECK(run->error < 0.5);
    CHECK(apart(*run, truth) > 0.15);
  }
  CHECK(midpoint.error < 1e-3);
  CHECK(total_strays(midpoint) < 5 / omega);  // even where both sums look right
  CHECK(total_strays(verlet) > 0.2);
}

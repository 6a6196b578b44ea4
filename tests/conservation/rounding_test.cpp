#include "integrators/all_schemes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/problems.hpp"

#include <cmath>
#include <optional>
#include <vector>

namespace noether {
namespace {

using namespace noether::test;

/// Energy of the pair in extended precision, with the low words where there are any.
Quad energy(const ParticleSystem<double>& s) {
  auto wide = s.as<Quad>();
  if (const auto* low = s.low_words()) {
    for (Index i = 0; i < s.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        wide.positions()[i][k] += Quad(low->x[i][k]);
        wide.velocities()[i][k] += Quad(low->v[i][k]);
      }
    }
  }
  auto hamiltonian = kinetic_potential<Quad>(Gravity{});
  hamiltonian.bind(wide);
  return hamiltonian.energy(wide).total();
}

/// Root mean square over 32 orbits of the relative energy error after 1, 4, 16, 64 times 250 steps, 100 steps to a
/// turn: at this step the error of the method lies below that of the arithmetic.
std::vector<ErrorPoint> rounding_errors(CompositionOptions options) {
  std::vector<ErrorPoint> points = {{250, 0}, {1000, 0}, {4000, 0}, {16000, 0}};
  constexpr int orbits = 32;
  for (int orbit = 0; orbit < orbits; ++orbit) {
    auto s = kepler_pair(0.2 + 0.003 * orbit, 0.1 * orbit);
    s.clock() = Clock<double>::fixed(0, 0.0628);
    Composition integrator(kinetic_potential(Gravity{}), schemes::sofroniou_spaletta_10_s35, options);
    integrator.bind(s);
    auto settled = s;
    const Quad start = energy(s);
    std::int64_t done = 0;
    for (ErrorPoint& point : points) {
      const auto until = static_cast<std::int64_t>(point.h);
      integrator.advance(s, {.steps = until - done});
      done = until;
      integrator.settle(s, settled, {}, std::nullopt, true);
      const double error = static_cast<double>((energy(settled) - start) / start);
      point.error += error * error / orbits;
    }
  }
  for (ErrorPoint& point : points) point.error = std::sqrt(point.error);
  return points;
}

TEST_CASE("rounding errors of the energy grow as the square root of time, and compensation shrinks them",
          "[conservation][slow]") {
  const auto plain = rounding_errors({}), compensated = rounding_errors({.compensated = true});
  INFO("plain\n" << to_text(plain) << "compensated\n" << to_text(compensated));
  CHECK(std::fabs(fitted_slope(plain) - 0.5) < 0.2);
  CHECK(std::fabs(fitted_slope(compensated) - 0.5) < 0.2);
  for (std::size_t k = 0; k < plain.size(); ++k) CHECK(compensated[k].error < plain[k].error / 16);
}

}  // namespace
}  // namespace noether

// The stiffness ratio, against eigenvalues that are known.

#include "integrators/stiffness.hpp"

#include "integrators/first_order_system.hpp"
#include "integrators/systems/forced_damped_oscillator.hpp"
#include "integrators/systems/heat_line.hpp"
#include "integrators/systems/lorenz.hpp"
#include "integrators/systems/prothero_robinson.hpp"
#include "integrators/systems/rc_ladder.hpp"
#include "integrators/systems/robertson.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace noether;

namespace {

template <class S> std::vector<std::complex<double>> eigenvalues(const S& system, const std::vector<double>& at) {
  SystemMotion<S, double> f(system);
  Vector<double> y(system.size());
  for (Index i = 0; i < y.size(); ++i) y[i] = at[static_cast<std::size_t>(i)];
  return eigenvalues_of(f, 0, y);
}
template <class S> Stiffness stiffness(const S& system, double length) {
  return stiffness_of(eigenvalues(system, system.start()), length);
}

}  // namespace

TEST_CASE("eigenvalues of the heat equation on a line are its rates of decay", "[stiffness]") {
  const HeatLine line{.points = 30, .length = 2, .diffusivity = 0.3};
  auto all = eigenvalues(line, line.start());
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.real() > b.real(); });
  for (std::size_t k = 0; k < all.size(); ++k) {
    CHECK(std::abs(all[k].real() / -line.rate_of(static_cast<std::int64_t>(k) + 1) - 1) < 1e-7);
    CHECK(std::abs(all[k].imag()) < 1e-7);
  }
  const Stiffness found = stiffness(line, 10);
  CHECK(std::abs(found.ratio / (10 * line.rate_of(30)) - 1) < 1e-8);
  CHECK(std::abs(found.spread() / (line.rate_of(30) / line.rate_of(1)) - 1) < 1e-7);
}

TEST_CASE("S of the heat equation grows with the square of the points", "[stiffness]") {
  const double some = stiffness(HeatLine{.points = 49}, 1).ratio, more = stiffness(HeatLine{.points = 99}, 1).ratio;
  CHECK(std::abs(std::log2(more / some) - 2) < 2e-3);
}

TEST_CASE("eigenvalues of a driven oscillator and of Lorenz's origin are those on paper", "[stiffness]") {
  const Stiffness oscillator = stiffness(ForcedDampedOscillator{.omega0 = 2, .gamma = 0.5}, 100);
  CHECK(std::abs(oscillator.fastest - 0.5) < 1e-7);
  CHECK(std::abs(oscillator.turning - std::sqrt(3.75)) < 1e-7);
  const Lorenz lorenz;
  const Stiffness origin = stiffness_of(eigenvalues(lorenz, {0, 0, 0}), 1);
  const double root = std::sqrt(11.0 * 11 + 4 * 10 * 27);
  CHECK(std::abs(origin.fastest - (11 + root) / 2) < 1e-6);
  CHECK(std::abs(origin.growth - (root - 11) / 2) < 1e-6);
  CHECK(std::abs(origin.slowest - 8.0 / 3) < 1e-6);
}

TEST_CASE("the time constants of a ladder are as far apart as its capacitors", "[stiffness]") {
  const Stiffness two = stiffness(RcLadder{.stages = 2, .spread = 1e8}, 1);
  // R C_1 = 1 and R C_2 = 1e-8: the fast stage relaxes at 1/(R C_2), the slow one is left with the source's resistor.
  CHECK(std::abs(two.fastest / 1e8 - 1) < 1e-6);
  CHECK(std::abs(two.slowest - 1) < 1e-6);
  CHECK(stiffness(RcLadder{}, 1).spread() > 1e6);
}

TEST_CASE("Robertson's kinetics begin with one rate, and S counts the length of the run", "[stiffness]") {
  const Stiffness found = stiffness(Robertson{}, 1e11);
  CHECK(std::abs(found.ratio / 4e9 - 1) < 1e-8);
  CHECK(found.spread() == 1);
  // Later B is small and fast: -2 k2 B - k3 C at t = 40.
  const Stiffness later =
      stiffness_of(eigenvalues(Robertson{}, {0.71582706871940, 9.1855347645572e-6, 0.28416374574583}), 1);
  CHECK(std::abs(later.fastest / (2 * 3e7 * 9.1855347645572e-6 + 1e4 * 0.28416374574583) - 1) < 0.01);
}

TEST_CASE("along its run Robertson's kinetics reach S = 1e15, far more than their start tells", "[stiffness]") {
  // In the end C = 1 and the rate is k3 = 1e4.
  const auto along = [](double length) {
    SystemMotion<Robertson, double> f{Robertson{}};
    const std::vector<double> values = Robertson{}.start();
    Vector<double> y(3);
    std::copy(values.begin(), values.end(), y.data());
    return stiffness_along(f, y, length);
  };
  const StiffnessAlong whole = along(1e11);
  CHECK(whole.reached == 1e11);
  CHECK(whole.places > 20);
  CHECK(std::abs(whole.mean.ratio / 1e15 - 1) < 0.05);
  CHECK(std::abs(whole.fastest / 1e4 - 1) < 0.05);
  CHECK(whole.mean.verdict() == "stiff: S = 1e+15; an explicit method needs about 3.6e+14 steps; use rodas_5p or bdf");
  // At t = 40 the rate is known: see above. It grows little by little, so the mean is below it.
  const StiffnessAlong early = along(40);
  CHECK(std::abs(early.fastest / (2 * 3e7 * 9.1855347645572e-6 + 1e4 * 0.28416374574583) - 1) < 0.01);
  CHECK(early.mean.fastest < early.fastest);
  CHECK(early.mean.fastest > early.fastest / 2);
}

TEST_CASE("where rates stay the same the run is as stiff as its start, forward and backward", "[stiffness]") {
  const HeatLine line{.points = 20};
  SystemMotion<HeatLine, double> f{line};
  const std::vector<double> values = line.start();
  Vector<double> y(static_cast<Index>(values.size()));
  std::copy(values.begin(), values.end(), y.data());
  const StiffnessAlong forward = stiffness_along(f, y, 0.5), backward = stiffness_along(f, y, -1e-3);
  CHECK(forward.reached == 0.5);
  CHECK(std::abs(forward.mean.ratio / (0.5 * line.rate_of(20)) - 1) < 1e-7);
  CHECK(std::abs(forward.mean.slowest / line.rate_of(1) - 1) < 1e-7);
  CHECK(forward.mean.growth == 0);
  CHECK(std::abs(backward.mean.growth / line.rate_of(20) - 1) < 1e-7);
}

TEST_CASE("a run of too many steps is seen in part, and the rest taken to be like it", "[stiffness]") {
  SystemMotion<ForcedDampedOscillator, double> f{ForcedDampedOscillator{.gamma = 0.1}};
  Vector<double> y(2);
  y << 1, 0;
  const StiffnessAlong found = stiffness_along(f, y, 1e7);
  CHECK(found.reached < 1e5);
  CHECK(found.reached > 100);
  CHECK(std::abs(found.mean.ratio / 1e6 - 1) < 1e-6);
  CHECK(found.mean.verdict() == "not stiff: S = 1e+06, but what oscillates is about as fast, and needs as many steps");
}

TEST_CASE("the verdict on stiffness is in plain words", "[stiffness]") {
  CHECK(stiffness(Robertson{}, 1e11).verdict() ==
        "stiff: S = 4e+09; an explicit method needs about 1.4e+09 steps; use rodas_5p or bdf");
  CHECK(stiffness(ProtheroRobinson{.lambda = -1e3}, 10).verdict() ==
        "mildly stiff: S = 1e+04; an explicit method needs at least about 3.6e+03 steps; compare dop853 with rodas_5p");
  CHECK(stiffness(ProtheroRobinson{.lambda = -2}, 10).verdict() ==
        "not stiff: S = 20; an explicit method such as dop853 is enough");
  CHECK(stiffness(ForcedDampedOscillator{.gamma = 0.1}, 1e7).verdict() ==
        "not stiff: S = 1e+06, but what oscillates is about as fast, and needs as many steps");
  CHECK(stiffness_of(eigenvalues(Lorenz{}, {0, 0, 0}), 1e6).verdict() ==
        "not stiff: S = 2.28e+07, but what grows is about as fast, and needs as many steps");
  CHECK(stiffness(ForcedDampedOscillator{.gamma = 0}, 1e7).verdict() ==
        "not stiff: nothing decays, the system oscillates");
  CHECK(stiffness(Robertson{}, std::numeric_limits<double>::infinity()).verdict() ==
        "the fastest rate is 0.04; how stiff a run is depends on its length, which is not given");
}

TEST_CASE("systems too large for their eigenvalues are refused, and Jacobians that are not finite", "[stiffness]") {
  const HeatLine line{.points = 401};
  CHECK_THROWS_WITH(eigenvalues(line, line.start()),
                    "401 variables are too many for their eigenvalues; at most 400 are expected");
  CHECK_THROWS_WITH(eigenvalues(Lorenz{}, {INFINITY, 0, 0}), "df[0]/dy[0] is not finite");
}

// The systems of first order: their closed solutions, invariants and fixed points.

#include "integrators/first_order_system.hpp"
#include "integrators/stiffness.hpp"
#include "integrators/systems/forced_damped_oscillator.hpp"
#include "integrators/systems/heat_line.hpp"
#include "integrators/systems/lorenz.hpp"
#include "integrators/systems/prothero_robinson.hpp"
#include "integrators/systems/rc_ladder.hpp"
#include "integrators/systems/robertson.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace noether;

namespace {

template <class S> Vector<double> rates_at(const S& system, double t, const std::vector<double>& y) {
  Vector<double> now(system.size()), dy(system.size());
  for (Index i = 0; i < now.size(); ++i) now[i] = y[static_cast<std::size_t>(i)];
  system.rates(t, now, dy);
  return dy;
}

/// Largest difference between the derivative of `exact`, by differences of order 4 with step `h`, and the rates there.
template <class S> double defect(const S& system, double t, double h) {
  const auto far_before = system.exact(t - 2 * h), before = system.exact(t - h), after = system.exact(t + h),
             far_after = system.exact(t + 2 * h);
  const Vector<double> dy = rates_at(system, t, system.exact(t));
  double worst = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double slope = (8 * (after[i] - before[i]) - (far_after[i] - far_before[i])) / (12 * h);
    worst = std::max(worst, std::abs(slope - dy[static_cast<Index>(i)]));
  }
  return worst;
}

/// The defect falls with h^4: what is left is that of the differences, and none of the solution.
template <class S> void check_exact(const S& system, double h) {
  for (const double t : {0.3, 1.7, 4.0}) {
    INFO("t = " << t);
    const double coarse = defect(system, t, h), fine = defect(system, t, h / 4);
    CHECK(std::log2(coarse / fine) / 2 > 3.8);
    CHECK(std::log2(coarse / fine) / 2 < 4.2);
  }
}

template <class S> std::vector<double> run(const S& system, const char* name, double end, double tolerance) {
  Simulation sim(initial_state(system), classical(system, method(name, {.rtol = tolerance, .atol = tolerance * 1e-6})));
  REQUIRE(sim.run_until(end).ok());
  return sim.particles().variables();
}

Matrix<double> jacobian_by_differences(VectorField<double>& f, const Vector<double>& y) {
  Matrix<double> J(y.size(), y.size());
  Vector<double> up(y.size()), down(y.size());
  for (Index j = 0; j < y.size(); ++j) {
    Vector<double> moved = y;
    moved[j] += 0.5;
    f.rate(0, moved, up);
    moved[j] -= 1;
    f.rate(0, moved, down);
    for (Index i = 0; i < y.size(); ++i) J(i, j) = up[i] - down[i];
  }
  return J;
}

/// Where the Jacobian is other than 0 is just what `sparsity` says.
template <class S> void check_sparsity(const S& system) {
  SystemMotion<S, double> f(system);
  const Matrix<double> J = jacobian_by_differences(f, Vector<double>::Constant(system.size(), 0.3));
  const Sparsity columns = f.sparsity();
  REQUIRE(columns.size() == static_cast<std::size_t>(system.size()));
  for (Index j = 0; j < system.size(); ++j) {
    std::vector<Index> rows;
    for (Index i = 0; i < system.size(); ++i) {
      if (J(i, j) != 0) rows.push_back(i);
    }
    CHECK(rows == columns[static_cast<std::size_t>(j)]);
  }
}

}  // namespace

TEST_CASE("closed solutions solve their equations, at every damping and at resonance", "[systems]") {
  const auto oscillator = [](double gamma, double omega) {
    return ForcedDampedOscillator{
        .omega0 = 1.5, .gamma = gamma, .amplitude = 0.7, .omega = omega, .position = 0.4, .velocity = -1.1};
  };
  check_exact(oscillator(0.2, 0.9), 0.1);
  check_exact(oscillator(1.5, 0.9), 0.1);
  check_exact(oscillator(4.0, 0.9), 0.1);
  check_exact(oscillator(0, 0.9), 0.1);
  check_exact(oscillator(0, 1.5), 0.1);
  check_exact(oscillator(0.2, 0), 0.1);
  check_exact(HeatLine{.points = 3, .length = 2, .diffusivity = 0.2, .left = 1, .right = -0.5, .mode = 2}, 0.2);
  check_exact(ProtheroRobinson{.lambda = -20, .omega = 1.3}, 0.1);
}

TEST_CASE("closed solutions begin where the systems do", "[systems]") {
  for (const double gamma : {0.0, 0.2, 1.5, 4.0}) {
    const ForcedDampedOscillator system{.omega0 = 1.5, .gamma = gamma, .position = 0.4, .velocity = -1.1};
    const std::vector<double> begin = system.exact(0);
    CHECK(std::abs(begin[0] - 0.4) < 1e-15);
    CHECK(std::abs(begin[1] + 1.1) < 1e-15);
  }
}

TEST_CASE("an oscillator's exp(-gamma t) cos(omega_d t) needs the velocity -gamma x at its start", "[systems]") {
  const double gamma = 0.1, omega_d = std::sqrt(1 - gamma * gamma);
  double right = 0, at_rest = 0;
  for (int k = 0; k <= 10'000; ++k) {
    const double t = k * 0.002, formula = std::exp(-gamma * t) * std::cos(omega_d * t);
    const auto x = [&](double velocity) {
      return ForcedDampedOscillator{.gamma = gamma, .amplitude = 0, .position = 1, .velocity = velocity}.exact(t)[0];
    };
    right = std::max(right, std::abs(x(-gamma) - formula));
    at_rest = std::max(at_rest, std::abs(x(0) - formula));
  }
  CHECK(right < 1e-15);
  CHECK(std::abs(at_rest - 0.0863) < 5e-5);
}

TEST_CASE("an explicit method of order 8 reproduces the closed solutions", "[systems]") {
  const ForcedDampedOscillator oscillator;
  const HeatLine heat{.points = 15, .diffusivity = 0.1, .left = 1, .mode = 3};
  const ProtheroRobinson follower{.lambda = -50};
  const auto check = [](const auto& system, double end) {
    const std::vector<double> y = run(system, "dop853", end, 1e-12), exact = system.exact(end);
    for (std::size_t i = 0; i < y.size(); ++i) CHECK(std::abs(y[i] - exact[i]) < 1e-10);
  };
  check(oscillator, 30);
  check(heat, 1);
  check(follower, 3);
}

TEST_CASE("Robertson's substances are neither made nor lost, and reach their published values at time 40",
          "[systems]") {
  const Robertson system;
  const Vector<double> dy = rates_at(system, 0, {0.7, 1e-5, 0.3});
  CHECK(std::abs(dy[0] + dy[1] + dy[2]) < 1e-16 * 3e7 * 1e-10);
  // Radau IIA of order 5 at tolerance 1e-14 agrees with these to all digits (HairerWanner1996, IV.1 for the picture).
  const std::vector<double> y = run(system, "dop853", 40, 1e-10);
  CHECK(std::abs(y[0] / 0.71582706871940 - 1) < 1e-8);
  CHECK(std::abs(y[1] / 9.1855347645572e-6 - 1) < 1e-6);
  CHECK(std::abs(y[2] / 0.28416374574583 - 1) < 1e-8);
}

TEST_CASE("Lorenz's system rests at its three fixed points", "[systems]") {
  const Lorenz system;
  const double far = std::sqrt(system.beta * (system.rho - 1));
  for (const double sign : {-1.0, 0.0, 1.0}) {
    const Vector<double> dy = rates_at(system, 0, {sign * far, sign * far, sign * sign * (system.rho - 1)});
    for (Index i = 0; i < 3; ++i) CHECK(std::abs(dy[i]) < 1e-13);
  }
  // On the z axis z decays by itself.
  const Vector<double> dy = rates_at(system, 0, {0, 0, 3});
  CHECK(dy[0] == 0);
  CHECK(dy[1] == 0);
  CHECK(dy[2] == -8);
}

TEST_CASE("a ladder rests when every capacitor has the voltage of its source; one stage charges exponentially",
          "[systems]") {
  const RcLadder ladder{.stages = 6, .voltage = 2.5};
  const Vector<double> dy = rates_at(ladder, 0, std::vector<double>(6, 2.5));
  for (Index i = 0; i < 6; ++i) CHECK(dy[i] == 0);
  const RcLadder one{.stages = 1, .resistance = 2, .capacitance = 0.5, .voltage = 3};
  CHECK(std::abs(run(one, "dop853", 1.5, 1e-12)[0] - 3 * (1 - std::exp(-1.5))) < 1e-11);
  CHECK(std::abs(ladder.capacitance_of(0) / ladder.capacitance_of(5) / 1e6 - 1) < 1e-14);
}

TEST_CASE("the line's rates of decay come near those of the heat equation as the square of the distance", "[systems]") {
  const double limit = 4 * std::numbers::pi * std::numbers::pi;
  const auto error = [&](std::int64_t points) { return limit - HeatLine{.points = points}.rate_of(2); };
  CHECK(std::abs(std::log2(error(19) / error(39)) - 2) < 0.02);
  CHECK(std::abs(std::log2(error(199) / error(399)) - 2) < 2e-4);
}

TEST_CASE("systems say rightly where their Jacobians can be other than 0", "[systems]") {
  check_sparsity(HeatLine{.points = 7});
  check_sparsity(HeatLine{.points = 1});
  check_sparsity(RcLadder{.stages = 7, .spread = 100});
  check_sparsity(RcLadder{.stages = 2});
}

TEST_CASE("systems refuse fields that make no sense, by name", "[systems]") {
  const auto refusal = [](const auto& system) {
    try {
      initial_state(system);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refusal(HeatLine{.points = 0}) == "points = 0 is too few; 1 or more is expected");
  CHECK(refusal(HeatLine{.points = 3, .mode = 4}) ==
        "mode = 4 cannot be resolved by the points; 1 to the number of points is expected");
  CHECK(refusal(RcLadder{.capacitance = -1}) ==
        "capacitance = -1 is not a valid capacitance; a time above 0 is expected");
  CHECK(refusal(Robertson{.k2 = -3}) == "k2 = -3 is not a valid rate; 0 or more is expected");
  CHECK(refusal(ForcedDampedOscillator{.gamma = -1}) == "gamma = -1 is not a valid drag; 0 or more is expected");
}

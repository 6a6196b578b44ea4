/// Explicit Runge-Kutta methods: orders, evaluations, error control, dense output, stability.

#include "integrators/classical.hpp"
#include "tests/methods/motions.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"

#include <cmath>
#include <complex>

using namespace noether;

namespace {

constexpr const char* all_explicit[] = {"euler", "heun", "rk4", "dormand_prince_5", "cash_karp_5", "dop853"};

MethodOptions fixed_steps(const char* name) {
  MethodOptions options;
  if (methods::find(name)->adaptive) options.adaptive = false;
  return options;
}

/// Henon and Heiles at t = 20, from integrators.md 6, to 22 digits.
Vector<Quad> henon_heiles_at_20() {
  Vector<Quad> y(4);
  y << 0.1199368952782719296202_q, 0.2809431280773217541052_q, 0.1506484736107446417959_q, 0.1675336702728667023031_q;
  return y;
}

/// The matrix of one step of q'' = -q, applied to (1, 0) and (0, 1).
std::array<double, 4> step_matrix(const char* name, double z) {
  auto f = test::oscillator<double>();
  std::array<double, 4> m{};
  for (int k = 0; k < 2; ++k) {
    const auto method = test::make<double>(name, fixed_steps(name));
    Vector<double> y = Vector<double>::Zero(2);
    y[k] = 1;
    y = test::walk(*method, f, y, z, 1);
    m[static_cast<std::size_t>(k)] = y[0];
    m[static_cast<std::size_t>(2 + k)] = y[1];
  }
  return m;
}

/// Growth of the amplitude in one step, |R(i z)|.
double growth(const char* name, double z) {
  const auto m = step_matrix(name, z);
  return std::sqrt(std::abs(m[0] * m[3] - m[1] * m[2]));
}

/// The first z beyond which amplitudes grow by more than `threshold` a step.
double imaginary_limit(const char* name, double threshold) {
  double z = 1e-3;
  while (growth(name, z) <= 1 + threshold && z < 10) z += 1e-3;
  double low = z - 1e-3;
  for (int k = 0; k < 40; ++k) {
    const double middle = (low + z) / 2;
    (growth(name, middle) <= 1 + threshold ? low : z) = middle;
  }
  return z;
}

}  // namespace

TEST_CASE("every explicit Runge-Kutta method has its order on Henon and Heiles", "[order]") {
  const Vector<Quad> exact = henon_heiles_at_20();
  for (const char* name : all_explicit) {
    auto f = test::henon_heiles<Quad>();
    const auto method = test::make<Quad>(name, fixed_steps(name));
    const int order = methods::find(name)->order;
    std::vector<test::ErrorPoint> points;
    for (const long n : {long{640}, long{960}, long{1280}}) {
      const long steps = order == 1 ? 64 * n : order == 2 ? 4 * n : order > 5 ? n / 4 : n;
      const double h = 20.0 / static_cast<double>(steps);
      points.push_back({h, test::distance(test::walk(*method, f, test::henon_heiles_start<Quad>(), h, steps), exact)});
    }
    // Steps that are no doubles end a little beside 20: 1e-17 of it.
    CAPTURE(name, test::to_text(points));
    CHECK(std::abs(test::fitted_slope(points) - order) < 0.2);
  }
}

TEST_CASE("the error of one step is one order higher than that of many", "[order]") {
  // Claim C2: h^2 for Euler, h^5 for RK4.
  const std::pair<const char*, double> expected[] = {{"euler", 2}, {"rk4", 5}};
  for (const auto& [name, slope] : expected) {
    auto f = test::henon_heiles<Quad>();
    const auto method = test::make<Quad>(name);
    const auto reference = test::make<Quad>("dop853", {.adaptive = false});
    std::vector<test::ErrorPoint> points;
    for (const double h : {0x1p-4, 0x1p-5, 0x1p-6}) {
      const auto exact = test::walk(*reference, f, test::henon_heiles_start<Quad>(), h / 64, 64);
      points.push_back({h, test::distance(test::walk(*method, f, test::henon_heiles_start<Quad>(), h, 1), exact)});
    }
    CAPTURE(name, test::to_text(points));
    CHECK(std::abs(test::fitted_slope(points) - slope) < 0.1);
  }
}

TEST_CASE("a step costs the evaluations that the method is known for", "[cost]") {
  // Claim C5: six for Dormand and Prince, whose last stage is the first of the next step, and twelve for DOP853.
  const std::pair<const char*, int> expected[] = {
      {"euler", 1}, {"heun", 2}, {"rk4", 4}, {"dormand_prince_5", 6}, {"cash_karp_5", 6}, {"dop853", 12}};
  for (const auto& [name, evaluations] : expected) {
    auto f = test::henon_heiles<double>();
    const auto method = test::make<double>(name, fixed_steps(name));
    test::walk(*method, f, test::henon_heiles_start<double>(), 0.01, 50);
    const bool first = evaluations == 6 && std::string_view(name) != "cash_karp_5";
    CAPTURE(name);
    CHECK(f.evaluations().force == 50 * evaluations + (first || evaluations == 12 ? 1 : 0));
  }
}

TEST_CASE("a tighter tolerance costs what the order says, and is kept", "[adaptive]") {
  for (const char* name : {"dormand_prince_5", "cash_karp_5", "dop853"}) {
    std::vector<test::ErrorPoint> points;
    for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-12}) {
      const auto method = test::make<double>(name, {.rtol = tolerance, .atol = tolerance});
      const test::Travelled done = test::once_around(*method);
      CAPTURE(name, tolerance, done.error, done.evaluations);
      CHECK(done.error < 300 * tolerance);
      points.push_back({1.0 / static_cast<double>(done.evaluations), done.error});
    }
    CAPTURE(name, test::to_text(points));
    CHECK(test::fitted_slope(points) > methods::find(name)->order - 1);
  }
}

TEST_CASE("a step that is too long is rejected and tried again", "[adaptive]") {
  for (const char* name : {"dormand_prince_5", "cash_karp_5", "dop853"}) {
    const auto method = test::make<double>(name, {.rtol = 1e-9, .atol = 1e-9, .first = 2.0});
    const test::Travelled done = test::once_around(*method);
    CAPTURE(name);
    CHECK(done.rejected >= 1);
    CHECK(done.error < 3e-7);
  }
}

TEST_CASE("dense output has the order that it is known for", "[dense]") {
  // Errors of one step at points inside it: h^5 for order 4, h^8 for order 7.
  const std::pair<const char*, double> expected[] = {{"dormand_prince_5", 5}, {"dop853", 8}};
  for (const auto& [name, slope] : expected) {
    auto f = test::henon_heiles<Quad>();
    const auto reference = test::make<Quad>("dop853", {.adaptive = false});
    std::vector<test::ErrorPoint> points;
    for (const double h : {0x1p-2, 0x1p-3, 0x1p-4}) {
      double worst = 0;
      const auto method = test::make<Quad>(name, {.adaptive = false});
      // After a step before it, so that the stage kept from it is used.
      auto start = test::walk(*reference, f, test::henon_heiles_start<Quad>(), h / 32, 32);
      method->bind(f);
      Vector<Quad> y = test::henon_heiles_start<Quad>(), inside(4);
      REQUIRE(!method->step(f, Quad(0), y, h).failure);
      start = y;
      REQUIRE(!method->step(f, Quad(h), y, h).failure);
      for (const int eighths : {0, 1, 3, 5, 8}) {
        method->interpolate(f, Quad(eighths) / Quad(8), inside);
        const auto exact = test::walk(*reference, f, start, h / 64 * eighths / 8, 64);
        worst = std::max(worst, test::distance(inside, exact));
      }
      points.push_back({h, worst});
    }
    CAPTURE(name, test::to_text(points));
    CHECK(std::abs(test::fitted_slope(points) - slope) < 0.3);
  }
}

TEST_CASE("oscillations grow beyond the tabulated step and not below", "[stability]") {
  // integrators.md 1.1: Cash and Karp's 0.139 is where they grow by 1e-9 a step, 0.884 by 1e-4.
  CHECK(std::abs(imaginary_limit("rk4", 1e-12) - 2.8284271247) < 1e-6);
  CHECK(std::abs(imaginary_limit("dormand_prince_5", 1e-12) - 0.998) < 1e-3);
  CHECK(std::abs(imaginary_limit("cash_karp_5", 1e-9) - 0.139) < 1e-3);
  CHECK(std::abs(imaginary_limit("cash_karp_5", 1e-4) - 0.884) < 1e-3);
  CHECK(std::abs(imaginary_limit("dop853", 1e-12) - 5.961) < 1e-3);
  CHECK(imaginary_limit("euler", 1e-12) < 2e-3);
  CHECK(std::abs(growth("euler", 0.5) - std::sqrt(1.25)) < 1e-14);
  CHECK(std::abs(growth("heun", 0.1) - (1 + 1e-4 / 8)) < 1e-8);
}

TEST_CASE("RK4 damps an oscillation by 1 - z^6/144 a step", "[stability]") {
  for (const double z : {0.1, 0.2, 0.4}) {
    const double damped = 1 - growth("rk4", z), expected = std::pow(z, 6) / 144;
    CAPTURE(z);
    CHECK(std::abs(damped / expected - 1) < z * z);
  }
}

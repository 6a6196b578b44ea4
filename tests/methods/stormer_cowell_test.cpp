/// Stoermer and Cowell's method in summed form: order, stability, and round-off on the outer Solar System.

#include "integrators/methods/stormer_cowell.hpp"
#include "forces/gravity.hpp"
#include "integrators/classical.hpp"
#include "study/multistep_roots.hpp"
#include "tests/methods/first_unstable.hpp"
#include "tests/methods/motions.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/planets.hpp"

using namespace noether;

namespace {

constexpr int stormer_orders[] = {12, 13, 14};

/// Largest |q| of the oscillator over `steps` steps of h omega = z.
double largest(int order, double z, long steps) {
  auto f = test::oscillator<double>();
  StormerCowell<double> method("stormer", order);
  method.bind(f);
  Vector<double> y(2);
  y << 1, 0;
  double worst = 0;
  for (long n = 0; n < steps; ++n) {
    method.step(f, static_cast<double>(n) * z, y, z);
    worst = std::max(worst, std::abs(y[0]));
  }
  return worst;
}

/// Relative energy errors of the outer Solar System, `samples` times over 10^4 years.
std::vector<double> energy_errors(int order, double h, int samples) {
  auto s = test::outer_planets();
  auto integrator =
      test::classical_over(Gravity{.G = test::outer_G}, method("stormer_cowell_" + std::to_string(order)));
  s.clock() = Clock<double>::fixed(0, h);
  integrator.bind(s);
  const double start = integrator.energy(s).total();
  std::vector<double> errors;
  const auto steps = static_cast<std::int64_t>(3652500 / h) / samples;
  for (int k = 0; k < samples; ++k) {
    integrator.advance(s, {.steps = steps});
    errors.push_back(integrator.energy(s).total() / start - 1);
  }
  return errors;
}

}  // namespace

TEST_CASE("Stoermer-Cowell has the order of its number, positions and velocities alike", "[methods]") {
  auto f = test::henon_heiles<Quad>();
  const auto start = test::henon_heiles_start<Quad>();
  const auto exact = test::make<Quad>("gragg_bulirsch_stoer", {.rtol = 1e-32, .atol = 1e-32});
  const auto truth = test::travel(*exact, f, start, Quad(6));
  for (const int order : stormer_orders) {
    std::vector<test::ErrorPoint> positions, velocities;
    for (const long steps : {384L, 512L, 768L}) {
      StormerCowell<Quad> method("stormer", order);
      const double h = 6.0 / static_cast<double>(steps);
      const Vector<Quad> y = test::walk<Quad>(method, f, start, h, steps);
      positions.push_back({h, test::distance<Quad>(y.head(2), truth.head(2))});
      velocities.push_back({h, test::distance<Quad>(y.tail(2), truth.tail(2))});
    }
    CAPTURE(order, test::to_text(positions), test::to_text(velocities));
    CHECK(std::abs(test::fitted_slope(positions) - order) < 0.15);
    CHECK(std::abs(test::fitted_slope(velocities) - order) < 0.15);
  }
}

TEST_CASE("Stoermer-Cowell is stable on the oscillator up to the limit its table tells", "[methods]") {
  for (const int order : stormer_orders) {
    const double limit = methods::find("stormer_cowell_" + std::to_string(order))->stability_limit;
    const double z =
        test::first_unstable([roots = stoermer_roots(order)](double at) { return roots.growth(at); }, 1e-9, 0.5);
    CAPTURE(order, z, limit);
    CHECK(std::abs(z - limit) < 2e-5);
    CHECK(largest(order, limit - 1e-3, 20000) < 1.001);
    CHECK(largest(order, limit + 1e-3, 20000) > 1e3);
  }
}

TEST_CASE("summed Stoermer of order 14 keeps the energy of the outer Solar System to rounding", "[methods]") {
  const int samples = 200;
  const std::vector<double> errors = energy_errors(14, 22, samples);
  double worst = 0, xx = 0, xy = 0;
  for (int k = 0; k < samples; ++k) {
    const double x = (k + 1.0) / samples, error = errors[static_cast<std::size_t>(k)];
    worst = std::max(worst, std::abs(error));
    xx += x * x;
    xy += x * error;
  }
  CAPTURE(worst, xy / xx);
  CHECK(worst < 6e-15);
  // What grows in proportion to time is no more than what does not.
  CHECK(std::abs(xy / xx) < 6e-15);
}

TEST_CASE("at 40 days Stoermer of order 14 loses the outer Solar System, of order 12 it does not", "[methods]") {
  double worst14 = 0, worst12 = 0;
  for (const double error : energy_errors(14, 40, 20)) worst14 = std::max(worst14, std::abs(error));
  for (const double error : energy_errors(12, 40, 20)) worst12 = std::max(worst12, std::abs(error));
  CAPTURE(worst14, worst12);
  CHECK(worst14 > 1e-3);
  CHECK(worst12 < 1e-10);
}

TEST_CASE("Stoermer-Cowell takes one evaluation per step after a start of 193 a step", "[methods]") {
  for (const int order : stormer_orders) {
    auto f = test::henon_heiles<double>();
    StormerCowell<double> method("stormer", order);
    test::walk<double>(method, f, test::henon_heiles_start<double>(), 0.01, 100);
    CAPTURE(order);
    CHECK(f.evaluations().force == 101 + 192 * (order - 1));
  }
}

TEST_CASE("Stoermer-Cowell and the Nystroem pair serve forces of positions on particles only", "[methods]") {
  for (const char* name : {"stormer_cowell_14", "dprkn_12"}) {
    const auto claims = test::make<double>(name)->claims();
    CHECK(claims.second_order_only);
    CHECK(claims.positions_only);
  }
}

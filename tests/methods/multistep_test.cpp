/// Adams methods of fixed steps: coefficients, orders, stability, evaluations, what cannot be solved.

#include "integrators/methods/adams.hpp"
#include "integrators/methods/difference_formulas.hpp"
#include "study/multistep_roots.hpp"
#include "tests/methods/first_unstable.hpp"
#include "tests/methods/motions.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"

#include <fmt/format.h>

using namespace noether;

namespace {

/// Henon and Heiles in Quad after t = 6, to more than 28 digits.
const Vector<Quad>& henon_heiles_truth() {
  static const Vector<Quad> state = [] {
    auto f = test::henon_heiles<Quad>();
    const auto method = test::make<Quad>("gragg_bulirsch_stoer", {.rtol = 1e-32, .atol = 1e-32});
    return test::travel(*method, f, test::henon_heiles_start<Quad>(), Quad(6));
  }();
  return state;
}

double order_on_henon_heiles(Method<Quad>& method) {
  auto f = test::henon_heiles<Quad>();
  std::vector<test::ErrorPoint> points;
  for (const long steps : {192L, 256L, 384L}) {
    const double h = 6.0 / static_cast<double>(steps);
    points.push_back(
        {h, test::distance(henon_heiles_truth(), test::walk(method, f, test::henon_heiles_start<Quad>(), h, steps))});
  }
  return test::fitted_slope(points);
}

/// Error of the position at t = 10 of the oscillator that starts at (1, 0).
double error_on_oscillator(const char* name, double h) {
  auto f = test::oscillator<double>();
  const auto method = test::make<double>(name);
  Vector<double> y(2);
  y << 1, 0;
  return std::abs(test::walk(*method, f, y, h, std::lround(10 / h))[0] - std::cos(10.0));
}

double adams_growth(AdamsKind kind, int order, double z) {
  return adams_roots(kind, order, {.omega = 1, .rate = 0, .lambda = {}}).growth(z);
}

/// ln of how much the oscillator grew in `steps` steps of h omega = z, after as many to settle.
double growth_in_a_run(AdamsKind kind, int order, double z, long steps) {
  auto f = test::oscillator<double>();
  Adams<double> method("adams", kind, order);
  method.bind(f);
  Vector<double> y(2);
  y << 1, 0;
  double before = 1;
  for (long n = 0; n < 2 * steps; ++n) {
    if (n == steps) before = std::hypot(y[0], y[1]);
    method.step(f, static_cast<double>(n) * z, y, z);
  }
  return std::log(std::hypot(y[0], y[1]) / before);
}

}  // namespace

TEST_CASE("coefficients of Adams, Stoermer and Cowell come out as printed in the books", "[methods]") {
  const auto equal = [](Quad a, long over, long under) {
    CAPTURE(over, under, static_cast<double>(a));
    CHECK(static_cast<double>(abs(a - Quad(over) / Quad(under))) < 1e-32);
  };
  const auto ab = differences::adams_bashforth(7), am = differences::adams_moulton(7);
  const std::vector<std::pair<long, long>> bashforth = {{1, 1},     {1, 2},    {5, 12},       {3, 8},
                                                        {251, 720}, {95, 288}, {19087, 60480}};
  const std::vector<std::pair<long, long>> moulton = {{1, 1},     {-1, 2},   {-1, 12},     {-1, 24},
                                                      {-19, 720}, {-3, 160}, {-863, 60480}};
  for (std::size_t j = 0; j < 7; ++j) {
    equal(ab[j], bashforth[j].first, bashforth[j].second);
    equal(am[j], moulton[j].first, moulton[j].second);
  }
  const auto stoermer = differences::stoermer(7), cowell = differences::cowell(5);
  const std::vector<std::pair<long, long>> explicit_second = {{1, 1},    {0, 1},  {1, 12},     {1, 12},
                                                              {19, 240}, {3, 40}, {863, 12096}};
  const std::vector<std::pair<long, long>> implicit_second = {{1, 1}, {-1, 1}, {1, 12}, {0, 1}, {-1, 240}};
  for (std::size_t j = 0; j < 7; ++j) equal(stoermer[j], explicit_second[j].first, explicit_second[j].second);
  for (std::size_t j = 0; j < 5; ++j) equal(cowell[j], implicit_second[j].first, implicit_second[j].second);
  // Order 4 as everybody writes it: (55, -59, 37, -9) / 24 and (9, 19, -5, 1) / 24.
  const auto four = ordinates(differences::adams_bashforth(4)),
             four_implicit = ordinates(differences::adams_moulton(4));
  const long weights[4] = {55, -59, 37, -9}, weights_implicit[4] = {9, 19, -5, 1};
  for (std::size_t i = 0; i < 4; ++i) {
    equal(four[i], weights[i], 24);
    equal(four_implicit[i], weights_implicit[i], 24);
  }
}

TEST_CASE("Adams methods have the order of their number on Henon and Heiles", "[methods]") {
  for (int order = 1; order <= 6; ++order) {
    for (const char* name : {"adams_bashforth_", "adams_moulton_"}) {
      const auto method = test::make<Quad>((name + std::to_string(order)).c_str());
      const double slope = order_on_henon_heiles(*method);
      CAPTURE(name, order, slope);
      CHECK(std::abs(slope - order) < (order == 1 ? 0.1 : 0.05));
      CHECK(method->claims().order == order);
    }
    Adams<Quad> both("pece", AdamsKind::pece, order);
    const double slope = order_on_henon_heiles(both);
    CAPTURE(order, slope);
    CHECK(std::abs(slope - order) < 0.05);
  }
  const auto fixed = test::make<Quad>("adams_pece", {.adaptive = false});
  CHECK(fixed->claims().order == 4);
  CHECK(std::abs(order_on_henon_heiles(*fixed) - 4) < 0.05);
}

TEST_CASE("on the oscillator Adams-Bashforth 4 shows slopes 3.96 to 3.98, order 5 about 5.01", "[methods]") {
  const auto slope = [](const char* name, double h) {
    return std::log2(error_on_oscillator(name, h) / error_on_oscillator(name, h / 2));
  };
  CHECK(std::abs(slope("ab4", 0.02) - 3.96) < 0.005);
  CHECK(std::abs(slope("ab4", 0.01) - 3.98) < 0.005);
  CHECK(std::abs(slope("ab5", 0.02) - 5.01) < 0.005);
}

TEST_CASE("Adams methods leave the imaginary axis where the tables say, at the growth the tables say", "[methods]") {
  struct Limit {
    AdamsKind kind;
    int order;
    double growth, limit, digits;
  };
  using enum AdamsKind;
  const Limit limits[] = {
      {bashforth, 3, 1e-11, 0.724, 1e-3}, {bashforth, 4, 1e-11, 0.43, 1e-3}, {bashforth, 5, 1e-7, 0.08, 5e-3},
      {bashforth, 6, 1e-7, 0.12, 6e-3},   {moulton, 3, 1e-7, 0.0394, 1e-3},  {moulton, 4, 1e-7, 0.13, 1e-3},
      {moulton, 5, 1e-7, 1.21, 3e-3},     {pece, 2, 1e-11, 1.288, 1e-3},     {pece, 3, 1e-7, 0.0394, 1e-3},
      {pece, 4, 1e-7, 0.10, 1e-2},        {pece, 5, 1e-7, 0.26, 2e-3}};
  for (const Limit& one : limits) {
    const double z =
        test::first_unstable([&](double at) { return adams_growth(one.kind, one.order, at); }, one.growth, 2);
    CAPTURE(static_cast<int>(one.kind), one.order, one.growth, z);
    CHECK(std::abs(z - one.limit) < one.digits);
  }
  // None at all: any step on an oscillator grows.
  for (const int order : {1, 2}) CHECK(adams_growth(bashforth, order, 0.01) > 0);
  CHECK(adams_growth(moulton, 3, 0.01) > 0);
  // The tables of methods carry the limits of growth 0.
  for (const auto& [kind, order, name] : {std::tuple(bashforth, 3, "ab3"), std::tuple(bashforth, 4, "ab4"),
                                          std::tuple(moulton, 5, "am5"), std::tuple(moulton, 6, "am6")}) {
    const double z =
        test::first_unstable([&, k = kind, p = order](double at) { return adams_growth(k, p, at); }, 1e-11, 2);
    CAPTURE(name, z);
    CHECK(std::abs(methods::find(name)->stability_limit - z) < 1e-5);
  }
}

TEST_CASE("runs of Adams methods grow as the roots of their formulas do", "[methods]") {
  using enum AdamsKind;
  struct Run {
    AdamsKind kind;
    int order;
    double growth;
  };
  for (const Run& run :
       {Run{bashforth, 2, 1e-4}, Run{bashforth, 3, 1e-3}, Run{bashforth, 4, 1e-3}, Run{bashforth, 5, 1e-3},
        Run{bashforth, 6, 1e-3}, Run{moulton, 3, 1e-4}, Run{moulton, 4, 1e-4}, Run{moulton, 5, 1e-3},
        Run{pece, 2, 1e-3}, Run{pece, 3, 1e-4}, Run{pece, 4, 1e-4}, Run{pece, 5, 1e-3}}) {
    const double z =
        test::first_unstable([&](double at) { return adams_growth(run.kind, run.order, at); }, run.growth, 2);
    const long steps = 20000;
    const double expected = std::log1p(adams_growth(run.kind, run.order, z)) * static_cast<double>(steps);
    const double seen = growth_in_a_run(run.kind, run.order, z, steps);
    CAPTURE(static_cast<int>(run.kind), run.order, z, expected, seen);
    CHECK(std::abs(seen - expected) < 0.02 * expected + 0.05);
  }
  // A thousandth below their limits the stable ones stay bounded, a thousandth above they are lost.
  for (const auto& [kind, order, limit] :
       {std::tuple(bashforth, 3, 0.72363), std::tuple(bashforth, 4, 0.42999), std::tuple(pece, 2, 1.28719)}) {
    CAPTURE(static_cast<int>(kind), order);
    CHECK(growth_in_a_run(kind, order, limit - 1e-3, 50000) < 0.01);
    CHECK(growth_in_a_run(kind, order, limit + 1e-3, 50000) > 10);
  }
}

TEST_CASE("Adams methods take the evaluations they tell, after a start that takes 96 a step", "[methods]") {
  const auto count = [](Method<double>& method, long steps) {
    auto f = test::henon_heiles<double>();
    test::walk(method, f, test::henon_heiles_start<double>(), 0.01, steps);
    return f.evaluations().force;
  };
  for (int order = 1; order <= 6; ++order) {
    Adams<double> explicit_one("ab", AdamsKind::bashforth, order), both("pece", AdamsKind::pece, order);
    CAPTURE(order);
    CHECK(count(explicit_one, 100) == 100 + 96 * (order - 1));
    CHECK(count(both, 100) == 200 + 95 * (order - 1));
  }
  // Implicit: so many times as it takes from one prediction to rounding.
  Adams<double> implicit("am", AdamsKind::moulton, 4);
  const auto much = count(implicit, 1000) - count(implicit, 500);
  CAPTURE(much);
  CHECK(much > 2 * 500);
  CHECK(much < 8 * 500);
}

TEST_CASE("an implicit Adams step is solved to rounding", "[methods]") {
  auto f = test::henon_heiles<double>();
  Adams<double> method("am", AdamsKind::moulton, 2);
  const Vector<double> y0 = test::henon_heiles_start<double>();
  Vector<double> y = y0, f0(4), f1(4);
  method.bind(f);
  method.step(f, 0, y, 0.25);
  f.rate(0, y0, f0);
  f.rate(0.25, y, f1);
  for (Index i = 0; i < 4; ++i) CHECK(std::abs(y[i] - y0[i] - 0.125 * (f0[i] + f1[i])) < 1e-16);
}

TEST_CASE("the trapezoidal rule undoes its steps, as it claims", "[methods]") {
  auto f = test::henon_heiles<Quad>();
  const auto method = test::make<Quad>("adams_moulton_2");
  CHECK(method->claims().reversible);
  method->bind(f);
  Vector<Quad> y = test::henon_heiles_start<Quad>();
  for (int n = 0; n < 10; ++n) method->step(f, Quad(0.25 * n), y, 0.25);
  CHECK(test::distance(y, test::henon_heiles_start<Quad>()) > 0.1);
  for (int n = 10; n > 0; --n) method->step(f, Quad(0.25 * n), y, -0.25);
  CHECK(test::distance(y, test::henon_heiles_start<Quad>()) < 1e-31);
}

TEST_CASE("an implicit Adams step that cannot be solved says so, and by how much it is too long", "[methods]") {
  auto f = test::oscillator<double>(100);
  Adams<double> method("adams_moulton_4", AdamsKind::moulton, 4);
  method.bind(f);
  Vector<double> y(2);
  y << 1, 0;
  StepResult made;
  for (int n = 0; n < 10 && !made.failure; ++n) made = method.step(f, n * 0.05, y, 0.05);
  REQUIRE(made.failure);
  CHECK(made.failure->kind == Outcome::Kind::solver_failure);
  CAPTURE(made.failure->message);
  CHECK(made.failure->message.find("'adams_moulton_4' could not solve its implicit step of 0.05 at time 0.1") == 0);
  CHECK(made.failure->message.find("take a step below 0.0") != std::string::npos);
}

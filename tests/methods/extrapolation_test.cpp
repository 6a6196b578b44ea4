/// Gragg, Bulirsch and Stoer: what tolerance gives, in double and in Quad, and what it costs.

#include "integrators/methods/extrapolation.hpp"
#include "tests/methods/motions.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"

using namespace noether;

namespace {

const MethodInfo& extrapolation_info() { return *methods::find("gragg_bulirsch_stoer"); }

template <class Real> test::Travelled extrapolated_around(double tolerance, bool midpoint) {
  Extrapolation<Real> method(extrapolation_info(), {.rtol = tolerance, .atol = tolerance});
  return test::once_around<Real>(method, midpoint);
}

/// One step of the harmonic numbers: error norms do not matter, so a huge tolerance passes with the first two rows.
template <class Real> Vector<Real> one_step(bool midpoint, double h, std::int64_t& evaluations) {
  auto f = test::kepler<Real>(midpoint);
  Extrapolation<Real> method(extrapolation_info(), {.rtol = 1e300, .atol = 1e300, .first = h});
  method.bind(f);
  Vector<Real> y = test::kepler_start<Real>(Real(0.6));
  method.step(f, Real(0), y, h);
  evaluations = f.evaluations().force;
  return y;
}

}  // namespace

TEST_CASE("the error of extrapolation follows its tolerance, by both rules", "[methods]") {
  for (const bool midpoint : {false, true}) {
    std::vector<test::ErrorPoint> points;
    test::Travelled last{1, 0, 0};
    std::int64_t rejected = 0;
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
      const test::Travelled now = extrapolated_around<double>(tolerance, midpoint);
      CAPTURE(midpoint, tolerance, now.error, now.evaluations, now.rejected);
      CHECK(now.error < last.error / 5);
      CHECK(now.error < 1e4 * tolerance);
      CHECK(now.evaluations > last.evaluations);
      rejected += now.rejected;
      points.push_back({tolerance, now.error});
      last = now;
    }
    CAPTURE(midpoint, test::to_text(points));
    CHECK(rejected > 0);
    CHECK(test::fitted_slope(points) > 0.8);
    CHECK(test::fitted_slope(points) < 1.25);
  }
}

TEST_CASE("extrapolation in Quad passes 28 digits once around Kepler's ellipse", "[methods]") {
  for (const bool midpoint : {false, true}) {
    const test::Travelled fine = extrapolated_around<Quad>(1e-32, midpoint),
                          coarse = extrapolated_around<Quad>(1e-24, midpoint);
    CAPTURE(midpoint, fine.error, fine.evaluations, coarse.error, coarse.evaluations);
    CHECK(fine.error < 3e-29);
    CHECK(coarse.error < 1e-20);
    CHECK(coarse.error > 1e-25);
    // Order and step rise together: a hundred million times less error for less than three times the work.
    CHECK(fine.evaluations < 3 * coarse.evaluations);
  }
  // Forces of positions need about half.
  CHECK(extrapolated_around<Quad>(1e-28, false).evaluations * 3 <
        extrapolated_around<Quad>(1e-28, true).evaluations * 2);
}

TEST_CASE("two rows of extrapolation are of order 4, and cost what their parts cost", "[methods]") {
  for (const bool midpoint : {false, true}) {
    std::vector<test::ErrorPoint> points;
    std::int64_t evaluations = 0, more = 0;
    auto f = test::kepler<Quad>(midpoint);
    for (const double h : {0.02, 0.01, 0.005}) {
      const auto exact = test::make<Quad>("gragg_bulirsch_stoer", {.rtol = 1e-30, .atol = 1e-30});
      const auto truth = test::travel<Quad>(*exact, f, test::kepler_start<Quad>(Quad(0.6)), Quad(h));
      points.push_back({h, test::distance(truth, one_step<Quad>(midpoint, h, evaluations))});
    }
    one_step<double>(midpoint, 0.01, more);
    CAPTURE(midpoint, test::to_text(points), evaluations);
    // The error of one step is of one order more than the method.
    CHECK(std::abs(test::fitted_slope(points) - 5) < 0.15);
    CHECK(evaluations == (midpoint ? 1 + 2 + 4 : 1 + 1 + 2));
    CHECK(more == evaluations);
  }
}

TEST_CASE("extrapolation of Henon and Heiles agrees with the printed state at t = 20", "[methods]") {
  auto f = test::henon_heiles<Quad>();
  const auto method = test::make<Quad>("gbs", {.rtol = 1e-30, .atol = 1e-30});
  const auto y = test::travel<Quad>(*method, f, Vector<Quad>::Constant(4, Quad(18) / Quad(100)), Quad(20));
  const char* printed[4] = {"0.1199368952782719296202", "0.2809431280773217541052", "0.1506484736107446417959",
                            "0.1675336702728667023031"};
  for (Index i = 0; i < 4; ++i) CHECK(static_cast<double>(abs(y[i] - parse_quad(printed[i]))) < 1e-22);
}

TEST_CASE("extrapolation cannot have fixed steps and says so", "[methods]") {
  CHECK_THROWS_WITH(test::make<double>("gbs", {.adaptive = false}),
                    "method 'gragg_bulirsch_stoer' chooses its steps itself; they cannot be fixed");
}

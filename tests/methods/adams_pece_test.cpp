/// Adams methods of variable step and order.

#include "integrators/methods/adams_pece.hpp"
#include "tests/methods/motions.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"

#include <numbers>

using namespace noether;

namespace {

const MethodInfo& adamspece_info() { return *methods::find("adams_pece"); }

template <class Real> test::Travelled adams_around(double tolerance) {
  AdamsPece<Real> method(adamspece_info(), {.rtol = tolerance, .atol = tolerance});
  return test::once_around<Real>(method);
}

}  // namespace

TEST_CASE("the error of the variable-order Adams method follows its tolerance", "[methods]") {
  std::vector<test::ErrorPoint> points;
  test::Travelled last{1, 0, 0};
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    const test::Travelled now = adams_around<double>(tolerance);
    CAPTURE(tolerance, now.error, now.evaluations, now.rejected);
    CHECK(now.error < last.error / 5);
    CHECK(now.error < 1e5 * tolerance);
    CHECK(now.evaluations > last.evaluations);
    CHECK(now.rejected > 0);
    points.push_back({tolerance, now.error});
    last = now;
  }
  // In proportion, on the whole.
  CAPTURE(test::to_text(points));
  CHECK(test::fitted_slope(points) > 0.85);
  CHECK(test::fitted_slope(points) < 1.25);
  // Order 12 makes ten thousand times less error for less than half as much more work.
  const test::Travelled coarse = adams_around<Quad>(1e-16), fine = adams_around<Quad>(1e-20);
  CAPTURE(coarse.error, coarse.evaluations, fine.error, fine.evaluations);
  CHECK(fine.error < coarse.error / 1000);
  CHECK(static_cast<double>(fine.evaluations) < 2.5 * static_cast<double>(coarse.evaluations));
}

TEST_CASE("the variable-order Adams method climbs to order 12 and takes two evaluations per step", "[methods]") {
  auto f = test::oscillator<double>();
  AdamsPece<double> method(adamspece_info(), {.rtol = 1e-12, .atol = 1e-12});
  method.bind(f);
  Vector<double> y(2);
  y << 1, 0;
  double t = 0;
  int highest = 0;
  std::int64_t steps = 0, rejected = 0;
  while (t < 200) {
    const StepResult made = method.step(f, t, y, 1e9);
    REQUIRE(!made.failure);
    t += made.h;
    ++steps;
    rejected += made.rejected;
    highest = std::max(highest, method.order());
  }
  CHECK(highest == AdamsPece<double>::most_order);
  // Two at the start find the length of the first step, one is the first rate.
  CHECK(f.evaluations().force == 3 + 2 * steps + rejected);
  CHECK(std::abs(y[0] - std::cos(t)) < 1e-8);
}

TEST_CASE("dense output of the Adams method meets the run at both ends and is as good inside", "[methods]") {
  auto f = test::oscillator<Quad>();
  AdamsPece<Quad> method(adamspece_info(), {.rtol = 1e-14, .atol = 1e-14});
  method.bind(f);
  CHECK(method.dense());
  Vector<Quad> y(2), before(2), inside(2);
  y << 1, 0;
  Quad t = 0;
  double worst = 0, worst_at_steps = 0, gap = 0;
  while (t < Quad(40)) {
    before = y;
    const StepResult made = method.step(f, t, y, 1e9);
    REQUIRE(!made.failure);
    const auto counted = f.evaluations().force;
    method.interpolate(f, Quad(0), inside);
    gap = std::max(gap, test::distance(inside, before));
    method.interpolate(f, Quad(1), inside);
    gap = std::max(gap, test::distance(inside, y));
    for (const double theta : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      method.interpolate(f, Quad(theta), inside);
      const Quad at = t + Quad(theta) * Quad(made.h);
      worst = std::max(worst, static_cast<double>(abs(inside[0] - cos(at))));
      worst = std::max(worst, static_cast<double>(abs(inside[1] + sin(at))));
    }
    CHECK(f.evaluations().force == counted);
    t += Quad(made.h);
    worst_at_steps = std::max(worst_at_steps, static_cast<double>(abs(y[0] - cos(t))));
  }
  CAPTURE(gap, worst, worst_at_steps);
  CHECK(gap < 1e-31);
  CHECK(worst < 2 * worst_at_steps);
  CHECK(worst_at_steps < 1e-11);
}

TEST_CASE("a tolerance that nothing can meet ends in a named failure", "[methods]") {
  // Straight into the center: the acceleration has no bound.
  auto f = test::kepler<double>();
  AdamsPece<double> method(adamspece_info(), {.rtol = 1e-8, .atol = 1e-8});
  method.bind(f);
  Vector<double> y(4);
  y << 1, 0, 0, 0;
  double t = 0;
  StepResult made;
  for (int n = 0; n < 100000 && !made.failure && t < 2; ++n) {
    made = method.step(f, t, y, 1e9);
    t += made.h;
  }
  REQUIRE(made.failure);
  CHECK(made.failure->kind == Outcome::Kind::step_underflow);
  CHECK(std::abs(t - std::numbers::pi / std::sqrt(8.0)) < 1e-3);
}
